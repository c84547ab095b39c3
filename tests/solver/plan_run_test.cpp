#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "solver/plan_scenes.h"

namespace luxel {
namespace {

using testing::paint;

const Rgb white(0.7, 0.6, 0.5), black = Rgb::Zero(), bright(3, 2, 1);

PlannedSolution run(const PatchMesh& mesh, const PlanOptions& options = {}) {
  const Enclosures enclosures = planned_enclosures(mesh, options);
  return run_plan(make_plan(mesh, enclosures, options), mesh, enclosures, options);
}

PlanOptions full() {
  PlanOptions options;
  options.savings = Savings::none();
  return options;
}

/// Area-weighted relative RMS difference of irradiance, worst channel: what accuracy is measured in.
double difference(const PatchMesh& mesh, const PatchField& one, const PatchField& other) {
  const Eigen::Map<const Eigen::VectorXd> areas(mesh.areas.data(), mesh.size());
  double worst = 0;
  for (Eigen::Index c = 0; c < one.cols(); ++c) {
    const double scale = areas.dot(other.col(c).cwiseAbs2());
    if (scale > 0) worst = std::max(worst, std::sqrt(areas.dot((one - other).col(c).cwiseAbs2()) / scale));
  }
  return worst;
}

struct NamedScene {
  const char* name;
  PatchMesh mesh;
};

std::vector<NamedScene> lit_scenes() {
  std::vector<NamedScene> scenes;
  scenes.push_back({"box", testing::rooms_in_a_row(1, 5, white)});
  scenes.push_back({"grey box", testing::rooms_in_a_row(1, 5, Rgb::Constant(0.5))});
  scenes.push_back({"three rooms", testing::rooms_in_a_row(3, 4, white)});
  scenes.push_back({"furnished room", testing::furnished_room(6, white)});
  scenes.push_back({"dim room", testing::furnished_room(4, Rgb::Constant(0.01))});
  scenes.push_back({"plates", testing::facing_plates(0.5, white)});
  for (NamedScene& scene : scenes) paint(scene.mesh, 0, 1, black, bright);
  scenes.push_back({"two lamps in two rooms", testing::rooms_in_a_row(2, 4, white)});
  paint(scenes.back().mesh, 0, 3, white, bright);
  paint(scenes.back().mesh, 100, 103, white, Rgb(0, 0, 2));
  return scenes;
}

TEST(RunPlan, AgreesWithTheFullRunToTheAccuracyAskedFor) {
  for (const auto& [name, mesh] : lit_scenes()) {
    const PlannedSolution planned = run(mesh), whole = run(mesh, full());

    EXPECT_TRUE(planned.solution.report.converged) << name;
    // each run may be off by the accuracy of its form factors, 1e-3
    EXPECT_LT(difference(mesh, planned.solution.irradiance, whole.solution.irradiance), 2e-3) << name;
    EXPECT_LT(planned.energy.imbalance, 1e-6) << name;  // the tolerance
    EXPECT_TRUE(planned.energy.emitted.isApprox(whole.energy.emitted, 1e-12)) << name;
    EXPECT_LE(planned.solution.report.relative_residual, 1e-6) << name;
  }
}

TEST(RunPlan, AgreesToRoundingWhereNothingIsSampledAndNothingHidden) {
  PatchMesh mesh = testing::rooms_in_a_row(1, 4, white);
  paint(mesh, 0, 2, black, bright);
  PlanOptions exact, every = full();
  exact.solve.tolerance = every.solve.tolerance = 1e-13;

  const PlannedSolution planned = run(mesh, exact), whole = run(mesh, every);

  EXPECT_LT(difference(mesh, planned.solution.irradiance, whole.solution.irradiance), 1e-11);
}

TEST(RunPlan, LeavesTheOtherRoomsExactlyDark) {
  PatchMesh mesh = testing::rooms_in_a_row(7, 3, white);
  paint(mesh, 54, 56, white, bright);

  const PlannedSolution light = run(mesh);

  for (int i = 0; i < mesh.size(); ++i) {
    const bool lit = i >= 54 && i < 108;
    EXPECT_EQ((light.solution.radiosity.row(i).array() > 0).all(), lit) << i;
    EXPECT_EQ((light.solution.irradiance.row(i).array() > 0).all(), lit) << i;
    EXPECT_EQ((light.solution.radiosity.row(i).array() == 0).all(), !lit) << i;
    EXPECT_EQ(std::isnan(light.row_sums[i]), !lit) << i;
  }
  EXPECT_EQ(light.form_factors.pairs, 54 * 53 / 2);
  EXPECT_EQ(light.form_factors.rays, 0);
}

TEST(RunPlan, SolvesARoomAmongOthersAsItIsAlone) {
  PatchMesh alone = testing::rooms_in_a_row(1, 3, white), row = testing::rooms_in_a_row(3, 3, white);
  paint(alone, 0, 2, white, bright);
  paint(row, 0, 2, white, bright);
  paint(row, 60, 61, white, bright);

  const PlannedSolution one = run(alone), three = run(row);

  EXPECT_EQ(three.solution.radiosity.topRows(54), one.solution.radiosity);
}

TEST(RunPlan, GivesProportionalChannelsTheirProportion) {
  PatchMesh mesh = testing::rooms_in_a_row(1, 3, Rgb::Constant(0.6));
  paint(mesh, 0, 1, Rgb::Constant(0.2), Rgb(8, 4, 0));

  const PatchField light = run(mesh).solution.radiosity;

  EXPECT_EQ(light.col(1), 0.5 * light.col(0));
  EXPECT_EQ(light.col(2).cwiseAbs().maxCoeff(), 0);
}

TEST(RunPlan, LetsAllOfALonePatchsLightEscape) {
  PatchMesh mesh = testing::Boxes().add({0, 0, 0}, {1, 1, 1}, false).mesh();
  paint(mesh, white);
  paint(mesh, 0, 1, white, bright);

  const PlannedSolution light = run(mesh);

  EXPECT_EQ(light.solution.radiosity, emission(mesh));
  EXPECT_EQ(light.solution.irradiance.cwiseAbs().maxCoeff(), 0);
  EXPECT_EQ(light.energy.emitted, light.energy.escaped);
  EXPECT_EQ(light.energy.imbalance, 0);
  EXPECT_TRUE(light.solution.report.converged);
}

TEST(RunPlan, KeepsTheLightBetweenPlatesThatNoRayConnects) {
  PatchMesh mesh = testing::facing_plates(1000, white);
  paint(mesh, 0, 1, white, bright);

  const PatchField irradiance = run(mesh).solution.irradiance;

  // F = 1 / (pi 1000^2), to 1e-6: the plates are points to each other
  EXPECT_NEAR(irradiance(1, 0), 3 / (M_PI * 1e6), 1e-5 * 3 / (M_PI * 1e6));
}

TEST(RunPlan, NamesTheMeshsPatchOfASingularRoom) {
  PatchMesh mesh = testing::rooms_in_a_row(3, 1, white);
  paint(mesh, 6, 12, Rgb(0.5, 1, 0.5), black);

  for (const PlanOptions& options : {PlanOptions(), full()}) {
    try {
      run(mesh, options);
      ADD_FAILURE() << "not refused";
    } catch (const SingularSystem& singular) {
      EXPECT_EQ(singular.patch(), 6);
      EXPECT_EQ(singular.channel(), 1);
    }
  }
}

TEST(RunPlan, TellsIterationsOfTheWholeMesh) {
  PatchMesh mesh = testing::rooms_in_a_row(3, 2, Rgb::Constant(0.5));
  paint(mesh, 24, 25, white, bright);
  int told = 0;
  PlanOptions options;
  options.solve.bounces = 2;
  options.solve.on_iteration = [&](const Iteration& iteration) {
    told +=
        iteration.radiosity && iteration.radiosity->rows() == mesh.size() && iteration.radiosity->cols() == 3;
    return true;
  };

  const PlannedSolution light = run(mesh, options);

  EXPECT_EQ(told, 3);  // the start and two bounces
  EXPECT_EQ(light.solution.report.stopped, Stopped::bounces);
  EXPECT_EQ(light.solution.report.history.size(), 3u);
}

TEST(RunPlan, StopsWhenTold) {
  PatchMesh mesh = testing::rooms_in_a_row(2, 2, white);
  paint(mesh, 0, 1, white, bright);
  paint(mesh, 24, 25, white, bright);
  PlanOptions options;
  options.solve.on_iteration = [](const Iteration&) { return false; };

  const PlannedSolution light = run(mesh, options);

  EXPECT_EQ(light.solution.report.stopped, Stopped::caller);
  EXPECT_FALSE(light.solution.report.converged);
}

TEST(RunPlan, GivesTheSameBitsOnOneThreadAndTwo) {
  PatchMesh mesh = testing::furnished_room(6, white);
  paint(mesh, 0, 1, white, bright);
  const auto on = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return run(mesh).solution.radiosity;
  };

  EXPECT_EQ(on(1), on(2));
}

TEST(RunPlan, UsesAnOperatorThatIsAtHand) {
  PatchMesh mesh = testing::furnished_room(4, Rgb::Constant(0.6));
  paint(mesh, 0, 1, black, bright);
  PlanOptions options;
  options.everything = true;
  const Enclosures enclosures = planned_enclosures(mesh);
  ClosedOperator closed = close_rows(form_factors(mesh).exchange_areas, mesh.areas, enclosures);
  const Plan plan = make_plan(mesh, enclosures, options);

  const PlannedSolution light = run_plan(plan, *closed.transport, mesh, options);
  const RadiositySolution direct = solve(*closed.transport, reflectance(mesh), emission(mesh));

  EXPECT_EQ(plan.systems.at(0).channels.solved.size(), 1u);
  // both to the tolerance of 1e-6
  EXPECT_LT(difference(mesh, light.solution.irradiance, direct.irradiance), 2e-6);
}

}  // namespace
}  // namespace luxel
