#include <gtest/gtest.h>

#include <vector>

#include "solver/hierarchical_scenes.h"

namespace luxel {
namespace {

using namespace luxel::testing;

HierarchicalSolution solved(const LitRoom& room, double accuracy, const SolveOptions& solving = {}) {
  return solve_hierarchical(room.mesh, enclosures_of(room.mesh), room.reflectance, room.emission, {accuracy},
                            solving);
}

TEST(SolveHierarchical, AgreesWithTheDenseOperatorWithinItsAccuracy) {
  const LitRoom room = lit_room(10, 5);
  const RadiositySolution exact = solve(*dense_of(room.mesh).transport, room.reflectance, room.emission);

  for (double accuracy : {0.05, 0.01, 0.004}) {
    const HierarchicalSolution solution = solved(room, accuracy);

    EXPECT_TRUE(solution.light.report.converged);
    EXPECT_LT(relative_rms(room.mesh, solution.light.irradiance, exact.irradiance), accuracy);
    const double brightest = exact.irradiance.maxCoeff();
    EXPECT_LT((solution.light.irradiance - exact.irradiance).cwiseAbs().maxCoeff(),
              10 * accuracy * brightest);
    // no light is made where none is emitted
    EXPECT_EQ(solution.light.radiosity.col(2).maxCoeff(), 0);
  }
}

TEST(SolveHierarchical, IsExactInAFurnace) {
  LitRoom room = lit_room(10, 5);
  for (double reflectance : {0.5, 0.9}) {
    room.reflectance.setConstant(reflectance);
    room.emission.setOnes();

    const PatchField radiosity = solved(room, 0.03).light.radiosity;

    // B = E / (1 - rho), and rows are closed to rounding
    const double expected = 1 / (1 - reflectance);
    EXPECT_LT((radiosity.array() - expected).abs().maxCoeff(), 1e-10 * expected);
  }
}

TEST(SolveHierarchical, IteratesOnPatchesWhereAFinishIsNotUniform) {
  LitRoom room = lit_room(10, 5);
  std::vector<int> one_finish(room.mesh.finishes.size(), 0);
  const PatchField apart = solved(room, 0.01).light.irradiance;
  room.mesh.finishes = one_finish;

  const HierarchicalSolution together = solved(room, 0.01);

  EXPECT_EQ(together.light.irradiance.rows(), room.mesh.size());
  EXPECT_LT(relative_rms(room.mesh, together.light.irradiance, apart), 0.02);  // 0.01 each
}

TEST(SolveHierarchical, BalancesItsEnergy) {
  const LitRoom room = lit_room(10, 5);
  const HierarchicalSolution solution = solved(room, 0.01);

  const Energy light = energy(*solution.transport, room.reflectance, room.emission, solution.light);

  // closed: all that is emitted is absorbed, up to the iteration's tolerance, a hundredth of the accuracy
  EXPECT_LT(light.imbalance, 1e-3);
  EXPECT_LT(std::abs(light.escaped[0]), 1e-9 * light.emitted[0]);
}

TEST(SolveHierarchical, WorksWithEveryMethodThatNeedsNoEntries) {
  const LitRoom room = lit_room(8, 4);
  SolveOptions solving;
  std::vector<PatchField> found;
  for (Method method : {Method::cg, Method::neumann, Method::gmres}) {
    solving.method = method;
    const HierarchicalSolution solution = solved(room, 0.01, solving);
    EXPECT_EQ(solution.light.report.method, method);
    EXPECT_TRUE(solution.light.report.converged);
    found.push_back(solution.light.radiosity);
  }

  // tolerance 1e-4 of the emission, which is met three times here
  EXPECT_LT(relative_rms(room.mesh, found[1], found[0]), 1e-3);
  EXPECT_LT(relative_rms(room.mesh, found[2], found[0]), 1e-3);
  solving.method = Method::cholesky;
  EXPECT_THROW(solved(room, 0.01, solving), std::invalid_argument);
}

TEST(SolveHierarchical, RefusesAClosedRoomThatAbsorbsNothing) {
  LitRoom room = lit_room(6, 3);
  room.reflectance.setOnes();

  EXPECT_THROW(solved(room, 0.03), SingularSystem);
}

TEST(SolveHierarchical, HandsNoRadiosityOfNodesToItsCaller) {
  const LitRoom room = lit_room(8, 4);
  int calls = 0;
  SolveOptions solving;
  solving.on_iteration = [&](const Iteration& step) {
    EXPECT_EQ(step.radiosity, nullptr);
    return ++calls < 3;
  };

  const HierarchicalSolution solution = solved(room, 0.01, solving);

  EXPECT_EQ(calls, 3);
  EXPECT_EQ(solution.light.report.stopped, Stopped::caller);
}

}  // namespace
}  // namespace luxel
