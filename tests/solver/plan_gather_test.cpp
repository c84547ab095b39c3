#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "luxel/input_error.h"
#include "luxel/plan.h"
#include "solver/gather_scenes.h"
#include "solver/plan_scenes.h"

namespace luxel {
namespace {

using namespace luxel::testing;

// A lamp on six patches of the floor, coloured.
PatchMesh lit_room(int k) {
  PatchMesh mesh = furnished_room(k, {0.7, 0.5, 0.3});
  paint(mesh, 0, 6, {0.5, 0.5, 0.5}, {10, 8, 6});
  return mesh;
}

PlanOptions accurate_to(double accuracy) {
  PlanOptions options;
  options.form_factors.accuracy = accuracy;
  return options;
}

TEST(RunGathered, AgreesWithTheDensePlan) {
  const PatchMesh mesh = lit_room(8);
  const PlanOptions fine = accurate_to(1e-3);
  const Enclosures enclosures = planned_enclosures(mesh, fine);
  const PlannedSolution exact = run_plan(make_plan(mesh, enclosures, fine), mesh, enclosures, fine);

  const GatheredRun run = run_gathered(mesh, accurate_to(0.01));

  EXPECT_TRUE(run.light.solution.report.converged);
  EXPECT_LT(relative_rms(mesh, run.light.solution.irradiance, exact.solution.irradiance), 0.01);
  EXPECT_TRUE(run.enclosures.closed);
  EXPECT_EQ(run.enclosures.count, 1);
  EXPECT_LE(run.light.solution.report.relative_residual, fine.solve.tolerance);
}

TEST(RunGathered, KeepsTheLightOfAClosedRoom) {
  const GatheredRun run = run_gathered(lit_room(8), accurate_to(0.01));

  // rows are 1, so that nothing escapes; what is not absorbed is the sampling's error
  EXPECT_EQ(run.light.energy.escaped.maxCoeff(), 0);
  EXPECT_GT(run.light.energy.emitted.minCoeff(), 0);
  EXPECT_LT(run.light.energy.imbalance, 0.01);
  for (const double sum : run.light.row_sums) EXPECT_EQ(sum, 1);
}

TEST(RunGathered, IsSymmetricWithinItsAccuracy) {
  const GatheredRun coarse = run_gathered(lit_room(8), accurate_to(0.05));
  const GatheredRun fine = run_gathered(lit_room(8), accurate_to(0.01));

  EXPECT_GT(coarse.light.reciprocity_error, 0);
  EXPECT_LT(fine.light.reciprocity_error, coarse.light.reciprocity_error);
}

TEST(RunGathered, SolvesProportionalChannelsOnce) {
  PatchMesh mesh = furnished_room(6, {0.6, 0.6, 0.6});
  paint(mesh, 0, 6, {0.5, 0.5, 0.5}, {10, 5, 0});

  const GatheredRun run = run_gathered(mesh, accurate_to(0.05));

  EXPECT_EQ(run.left_out.size(), 2u);  // the dark channel and the one that follows
  const PatchField& light = run.light.solution.radiosity;
  EXPECT_EQ(light.col(2).maxCoeff(), 0);
  EXPECT_LT((light.col(0) - 2 * light.col(1)).cwiseAbs().maxCoeff(), 1e-12 * light.maxCoeff());
  PlanOptions full = accurate_to(0.05);
  full.savings = Savings::none();
  EXPECT_TRUE(run_gathered(mesh, full).left_out.empty());
}

TEST(RunGathered, GivesZeroWhereNothingEmits) {
  const GatheredRun run = run_gathered(furnished_room(4, {0.5, 0.5, 0.5}), accurate_to(0.05));

  EXPECT_EQ(run.light.solution.radiosity.maxCoeff(), 0);
  EXPECT_TRUE(run.light.solution.report.converged);
  EXPECT_TRUE(run.enclosures.closed);
}

TEST(RunGathered, TellsOpenFromClosedEnclosures) {
  PatchMesh plates = facing_plates(1, {0.5, 0.5, 0.5});
  paint(plates, 0, 1, {0.5, 0.5, 0.5}, {1, 1, 1});

  const GatheredRun run = run_gathered(plates, accurate_to(0.01));

  EXPECT_FALSE(run.enclosures.closed);
  EXPECT_EQ(run.enclosures.count, 1);
  // F = 0.1998 between unit squares at distance 1 (Howell C-11)
  EXPECT_NEAR(run.light.row_sums[0], 0.1998, 0.01);
  EXPECT_NEAR(run.enclosures.open_share[0], 1 - run.light.row_sums[0], 1e-15);
}

TEST(RunGathered, TakesTheRaysThatTheAccuracyCallsFor) {
  const auto rays = [](double accuracy) {
    return run_gathered(lit_room(8), accurate_to(accuracy)).gather.plan.rays;
  };

  EXPECT_LT(rays(0.05), rays(0.01));
}

TEST(RunGathered, EstimatesItsErrorWhereAsked) {
  PlanOptions options = accurate_to(0.02);
  EXPECT_FALSE(run_gathered(lit_room(6), options).light.operator_error);
  options.error_bar = true;

  const GatheredRun run = run_gathered(lit_room(6), options);

  ASSERT_TRUE(run.light.operator_error);
  EXPECT_LE(run.light.operator_error->low, 0.02);
  EXPECT_GT(run.light.operator_error->high, 0);
  EXPECT_EQ(run.light.operator_error->row_sum_error_max, 0);
}

TEST(RunGathered, GivesTheStoredRaysLightWhereItIsStopped) {
  const PatchMesh mesh = lit_room(8);
  PlanOptions options = accurate_to(0.02);
  const PlanListener stopping{[](std::string_view stage, double, double) { return stage != "gather"; }, {}};
  EXPECT_THROW(run_gathered(mesh, options, stopping), Cancelled);
  options.keep_partial = true;

  const GatheredRun run = run_gathered(mesh, options, stopping);

  EXPECT_TRUE(run.gather.partial);
  const PatchField whole = run_gathered(mesh, options).light.solution.irradiance;
  // a quarter of the rays or less, not smoothed: rougher, but the same light
  const double off = relative_rms(mesh, run.light.solution.irradiance, whole);
  EXPECT_GT(off, 1e-3);
  EXPECT_LT(off, 0.2);
}

TEST(RunGathered, GivesTheSameBitsForAnyNumberOfThreads) {
  const PatchMesh mesh = lit_room(6);
  PlanOptions options = accurate_to(0.03);
  options.error_bar = true;
  GatheredRun serial;
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    serial = run_gathered(mesh, options);
  }

  const GatheredRun parallel = run_gathered(mesh, options);

  EXPECT_EQ(parallel.light.solution.radiosity, serial.light.solution.radiosity);
  EXPECT_EQ(parallel.light.operator_error->high, serial.light.operator_error->high);
  EXPECT_EQ(parallel.light.reciprocity_error, serial.light.reciprocity_error);
}

TEST(RunHierarchical, AgreesWithTheGatherWithinTheErrorBars) {
  const PatchMesh mesh = lit_room(8);
  PlanOptions options = accurate_to(0.01);
  options.error_bar = true;

  const HierarchicalRun clusters = run_hierarchical(mesh, options);
  const GatheredRun gathered = run_gathered(mesh, options);

  ASSERT_TRUE(clusters.light.operator_error && gathered.light.operator_error);
  EXPECT_LE(relative_rms(mesh, clusters.light.solution.irradiance, gathered.light.solution.irradiance),
            clusters.light.operator_error->high + gathered.light.operator_error->high);
  EXPECT_EQ(clusters.light.reciprocity_error, 0);
}

TEST(ChooseOperator, TakesDenseForAFewPatches) {
  const OperatorChoice choice = choose_operator(lit_room(8), accurate_to(1e-3), 1e9);

  EXPECT_EQ(choice.kind, OperatorKind::dense);
  ASSERT_EQ(choice.estimates.size(), 3u);
  for (const OperatorEstimate& estimate : choice.estimates) EXPECT_GT(estimate.cost.cpu_seconds, 0);
}

TEST(ChooseOperator, TakesWhatFitsIntoTheMemory) {
  const PatchMesh mesh = lit_room(40);  // 15,600 patches: half a gigabyte of entries

  const OperatorChoice choice = choose_operator(mesh, accurate_to(0.01), 2e8);

  EXPECT_NE(choice.kind, OperatorKind::dense);
  EXPECT_FALSE(choice.estimates.front().fits);
}

TEST(ChooseOperator, LeavesOutWhatCannotReachTheAccuracy) {
  const OperatorChoice choice = choose_operator(lit_room(8), accurate_to(1e-6), 1e9);

  EXPECT_EQ(choice.estimates.size(), 1u);
  EXPECT_EQ(choice.kind, OperatorKind::dense);
}

TEST(OperatorNames, AreReadAsTheyAreWritten) {
  for (const auto kind :
       {OperatorKind::automatic, OperatorKind::dense, OperatorKind::gather, OperatorKind::hierarchical}) {
    EXPECT_EQ(operator_from_name(name(kind)), kind);
  }
  EXPECT_FALSE(operator_from_name("sparse"));
}

}  // namespace
}  // namespace luxel
