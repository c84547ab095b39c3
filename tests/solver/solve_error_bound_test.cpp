#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "solver/solve_scenes.h"

namespace luxel {
namespace {

using test::all_methods;
using test::exact;
using test::largest_error;
using test::MatrixOperator;
using test::random_scene;

class ErrorBoundOf : public testing::TestWithParam<Method> {};

INSTANTIATE_TEST_SUITE_P(Solve, ErrorBoundOf, testing::ValuesIn(all_methods),
                         [](const auto& method) { return test::test_name(method.param); });

TEST_P(ErrorBoundOf, HoldsHoweverEarlyTheIterationStops) {
  SolveOptions options;
  options.method = GetParam();
  for (unsigned seed = 0; seed < 6; ++seed) {
    const auto transport =
        test::random_enclosure(40, seed, seed % 2 ? Precision::float32 : Precision::float64);
    const auto [reflectance, emission] = random_scene(40, 2, seed < 3 ? 0 : 0.97, 0.99, seed);
    const PatchField expected = exact(transport, reflectance, emission);
    for (const double tolerance : {1e-1, 1e-3, 1e-6, 1e-11}) {
      options.tolerance = tolerance;

      const auto solution = solve(transport, reflectance, emission, options);

      ASSERT_TRUE(std::isfinite(solution.report.error_bound));
      EXPECT_LE(largest_error(solution.radiosity, expected), solution.report.error_bound) << tolerance;
    }
  }
}

TEST_P(ErrorBoundOf, IsNotFarAboveTheError) {
  // a uniform residual in a furnace is the worst case of the norm: error = residual / (1 - rho), attained
  const auto transport = test::random_enclosure(40, 21);
  const PatchField reflectance = PatchField::Constant(40, 1, 0.99), emission = PatchField::Ones(40, 1);
  SolveOptions options;
  options.method = GetParam();
  options.tolerance = 1e-4;

  const auto solution = solve(transport, reflectance, emission, options);

  // sum over B* = 100: the bound can exceed 100 times the largest residual only by the rounding in it, 1e-11
  const PatchField residual =
      emission - solution.radiosity + reflectance.cwiseProduct(transport.rows() * solution.radiosity);
  const double attained = residual.cwiseAbs().maxCoeff() / 0.01 / solution.radiosity.maxCoeff();
  EXPECT_LT(solution.report.error_bound, 1.01 * attained + 1e-11);
}

TEST_P(ErrorBoundOf, StopsTheIterationBelowTheErrorAsked) {
  const auto transport = test::random_enclosure(60, 22, Precision::float32);
  const auto [reflectance, emission] = random_scene(60, 3, 0.999, 0.999, 23);
  const PatchField expected = exact(transport, reflectance, emission);
  SolveOptions options;
  options.method = GetParam();
  options.max_iterations = 100'000;
  for (const double error : {1e-2, 1e-6}) {
    options.error = error;

    const auto solution = solve(transport, reflectance, emission, options);

    EXPECT_TRUE(solution.report.converged) << solution.report.message;
    EXPECT_LE(solution.report.error_bound, error);
    EXPECT_LE(largest_error(solution.radiosity, expected), solution.report.error_bound);
  }
}

TEST_P(ErrorBoundOf, IsProvenForAWhiteEnclosureWithOneAbsorber) {
  // rho s = 1 everywhere but on one patch: the textbook bound does not exist
  const auto transport = test::random_enclosure(50, 24);
  PatchField reflectance = PatchField::Ones(50, 1);
  reflectance(7, 0) = 0.5;
  const PatchField emission = PatchField::Ones(50, 1);
  SolveOptions options;
  options.method = GetParam();
  options.tolerance = 1e-9;
  options.max_iterations = 100'000;

  const auto solution = solve(transport, reflectance, emission, options);

  EXPECT_TRUE(solution.report.converged) << solution.report.message;
  EXPECT_LE(largest_error(solution.radiosity, exact(transport, reflectance, emission)),
            solution.report.error_bound);
  EXPECT_LT(solution.report.error_bound, 1e-6);
}

TEST_P(ErrorBoundOf, DoesNotExistWhereRowsGainLight) {
  // spectral radius 1.148331 x 0.5 < 1 and row sums 1.2 x 0.5 < 1: bounded; at 0.9 neither
  const auto transport = test::cube_with_duplicate_floor();
  const PatchField emission = PatchField::Ones(7, 1);
  SolveOptions options;
  options.method = GetParam();

  const auto bounded = solve(transport, PatchField::Constant(7, 1, 0.5), emission, options);
  const auto unbounded = solve(transport, PatchField::Constant(7, 1, 0.9), emission, options);

  EXPECT_LE(bounded.report.error_bound, 1e-5);
  EXPECT_EQ(unbounded.report.error_bound, std::numeric_limits<double>::infinity());
  EXPECT_NE(unbounded.report.message.find("no error bound"), std::string::npos);
}

TEST(ErrorBound, IsProvenBetweenRowSumsAboveOneAndASpectralRadiusBelow) {
  // 1.2 x 0.85 = 1.02 but 1.148331 x 0.85 = 0.976 < 1: only a test vector shows it
  const auto transport = test::cube_with_duplicate_floor();
  const PatchField reflectance = PatchField::Constant(7, 1, 0.85), emission = PatchField::Ones(7, 1);

  const auto solution = solve(transport, reflectance, emission);

  EXPECT_LT(solution.report.error_bound, 1e-4);
  EXPECT_LE(largest_error(solution.radiosity, exact(transport, reflectance, emission)),
            solution.report.error_bound);
}

TEST(ErrorBound, ProfitsFromAbsorbersBesideAWhitePatch) {
  const auto transport = test::random_enclosure(100, 25);
  auto [reflectance, emission] = random_scene(100, 1, 0.1, 0.3, 26);
  reflectance(3, 0) = 0.9999;

  const auto report = solve(transport, reflectance, emission).report;

  // light leaves the white patch at once: the bound is near the residual, not 10,000 times it
  EXPECT_LT(report.error_bound, 1e3 * report.relative_residual);
}

TEST(ErrorBound, HoldsWithoutSymmetry) {
  std::mt19937 random(27);
  std::uniform_real_distribution<double> uniform(0, 1);
  Eigen::MatrixXd rows(50, 50);
  for (double& entry : rows.reshaped()) entry = uniform(random);
  rows.array().colwise() /= rows.rowwise().sum().array();
  const MatrixOperator transport(rows, Eigen::VectorXd::Ones(50));
  PatchField reflectance = PatchField::Ones(50, 1);
  reflectance(0, 0) = 0;
  const PatchField emission = PatchField::Ones(50, 1);
  const PatchField expected = exact(transport, reflectance, emission);

  for (const Method method : {Method::gmres, Method::neumann}) {
    SolveOptions options;
    options.method = method;
    const auto solution = solve(transport, reflectance, emission, options);

    EXPECT_LT(solution.report.error_bound, 1e-3);
    EXPECT_LE(largest_error(solution.radiosity, expected), solution.report.error_bound);
  }
}

}  // namespace
}  // namespace luxel
