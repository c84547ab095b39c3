#include <gtest/gtest.h>

#include "plan/cost_model.h"
#include "solver/plan_scenes.h"
#include "solver/solve_scenes.h"

namespace luxel {
namespace {

SolveShape room(double patches, int columns, double reflectance, double tolerance = 1e-6) {
  SolveShape shape;
  shape.patches = patches;
  shape.columns = {columns};
  shape.mean_reflectance = shape.largest_reflectance = reflectance;
  shape.tolerance = tolerance;
  return shape;
}

TEST(CheapestMethod, IsConjugateGradientsForAFewColumns) {
  EXPECT_EQ(cheapest_method(room(5000, 3, 0.8)), Method::cg);
  EXPECT_EQ(cheapest_method(room(50'000, 3, 0.5)), Method::cg);
}

TEST(CheapestMethod, IsAFactorisationForManyColumnsOfOneReflectance) {
  EXPECT_EQ(cheapest_method(room(5000, 300, 0.8)), Method::cholesky);
  SolveShape of_many = room(5000, 0, 0.8);
  of_many.columns.assign(300, 1);
  EXPECT_EQ(cheapest_method(of_many), Method::cg);
  SolveShape without_entries = room(5000, 300, 0.8);
  without_entries.entries = false;
  EXPECT_EQ(cheapest_method(without_entries), Method::cg);
}

TEST(CheapestMethod, CountsBouncesWhereFewSuffice) {
  EXPECT_EQ(cheapest_method(room(5000, 3, 0.8, 0.9)), Method::neumann);
  EXPECT_EQ(cheapest_method(room(5000, 3, 0.01)), Method::neumann);
  EXPECT_EQ(cheapest_method(room(5000, 3, 0.3)), Method::cg);
}

TEST(BouncesNeeded, AreThoseOfAGeometricSeries) {
  EXPECT_EQ(bounces_needed(0, 1e-6), 0);
  EXPECT_EQ(bounces_needed(0.1, 1e-3), 2);  // 0.1^3 = 1e-3
  EXPECT_EQ(bounces_needed(0.5, 1e-3), 9);  // 2^-10 < 1e-3
  EXPECT_EQ(bounces_needed(1, 1e-3), INFINITY);
}

TEST(BouncesNeeded, SufficeInEveryEnclosure) {
  for (const double reflectance : {0.02, 0.1, 0.4, 0.8}) {
    const auto [rho, emission] = test::random_scene(60, 3, reflectance, reflectance, 7);
    SolveOptions options;
    options.method = Method::neumann;

    const SolveReport report = solve(test::random_enclosure(60, 5), rho, emission, options).report;

    EXPECT_LE(report.iterations, bounces_needed(reflectance, options.tolerance)) << reflectance;
    EXPECT_TRUE(report.converged);
  }
}

TEST(EstimatedCost, CountsWhatThePlanLeavesOut) {
  PatchMesh mesh = testing::rooms_in_a_row(7, 6, Rgb::Constant(0.7));
  testing::paint(mesh, 0, 1, Rgb::Constant(0.7), Rgb::Constant(1));
  PlanOptions full;
  full.savings = Savings::none();
  const auto cost = [&](const PlanOptions& options) {
    const Enclosures enclosures = planned_enclosures(mesh, options);
    return estimated_cost(make_plan(mesh, enclosures, options), mesh, enclosures, options);
  };

  const Cost planned = cost({}), whole = cost(full);

  EXPECT_LT(planned.cpu_seconds, whole.cpu_seconds);
  EXPECT_LT(planned.bytes, whole.bytes);
  EXPECT_GT(planned.cpu_seconds, 0);
}

}  // namespace
}  // namespace luxel
