#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "solver/solve_scenes.h"

namespace luxel {
namespace {

using test::MatrixOperator;

/// Rows of a walk that leans to the next patches: nothing like symmetric.
MatrixOperator leaning_walk(int n) {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    rows(i, (i + 1) % n) = 0.7;
    rows(i, (i + 7) % n) += 0.2;
    rows(i, (i + n - 3) % n) += 0.1;
  }
  return {rows, Eigen::VectorXd::LinSpaced(n, 1, 2)};
}

TEST(SolveGmres, RestartsOnAnOperatorThatIsNotSymmetric) {
  const auto transport = leaning_walk(90);
  const auto [reflectance, emission] = test::random_scene(90, 3, 0.8, 0.99, 61);
  SolveOptions options;
  options.method = Method::gmres;
  options.tolerance = 1e-11;
  for (const int restart : {1, 5, 30}) {
    options.restart = restart;

    const auto solution = solve(transport, reflectance, emission, options);

    EXPECT_TRUE(solution.report.converged) << restart << ": " << solution.report.message;
    EXPECT_GT(solution.report.iterations, restart);
    EXPECT_LT(test::largest_error(solution.radiosity, test::exact(transport, reflectance, emission)), 1e-9);
  }
}

TEST(SolveGmres, EndsExactlyWhereItsDirectionsSpanTheSolution) {
  // two kinds of patches that see only their own kind's average: two distinct eigenvalues, two iterations
  const auto transport = test::sphere(Eigen::VectorXd::LinSpaced(20, 1, 3));
  SolveOptions options;
  options.method = Method::gmres;
  options.tolerance = 1e-13;

  const auto report =
      solve(transport, PatchField::Constant(20, 1, 0.9), test::random_scene(20, 1, 0, 1, 62).second, options)
          .report;

  EXPECT_TRUE(report.converged) << report.message;
  EXPECT_LE(report.iterations, 2);
}

TEST(SolveGmres, HasNoUseForMoreIterationsThanConjugateGradients) {
  const auto transport = test::random_enclosure(200, 63);
  const auto [reflectance, emission] = test::random_scene(200, 1, 0.8, 0.8, 64);
  SolveOptions gmres, cg;
  gmres.method = Method::gmres;
  cg.method = Method::cg;

  const auto by_gmres = solve(transport, reflectance, emission, gmres).report;
  const auto by_cg = solve(transport, reflectance, emission, cg).report;

  // GMRES minimises the very norm of the stopping rule, so that it is never behind
  EXPECT_LE(by_gmres.iterations, by_cg.iterations);
}

TEST(SolveCg, EstimatesTheConditionNumber) {
  const auto transport = test::random_enclosure(60, 65);
  const auto [reflectance, emission] = test::random_scene(60, 1, 0.9, 0.99, 66);
  SolveOptions options;
  options.method = Method::cg;
  options.tolerance = 1e-13;

  const auto report = solve(transport, reflectance, emission, options).report;

  const Eigen::VectorXd half = reflectance.col(0).cwiseSqrt();
  const Eigen::Map<const Eigen::VectorXd> areas(transport.areas().data(), 60);
  const Eigen::VectorXd root = areas.cwiseSqrt();
  const Eigen::MatrixXd symmetric =
      Eigen::MatrixXd::Identity(60, 60) -
      half.cwiseProduct(root).asDiagonal() * transport.rows() * half.cwiseQuotient(root).asDiagonal();
  const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric).eigenvalues();
  // Lanczos finds the extreme eigenvalues from inside, to a percent once the residual is at 1e-13
  const double condition = eigenvalues.maxCoeff() / eigenvalues.minCoeff();
  EXPECT_LE(report.condition_estimate, condition * (1 + 1e-8));
  EXPECT_GT(report.condition_estimate, 0.99 * condition);
}

TEST(SolveCg, NeedsAsManyIterationsAsThereAreEigenvalues) {
  // the inside of a sphere has the eigenvalues 0 and 1
  const auto transport = test::sphere(Eigen::VectorXd::LinSpaced(50, 1, 9));
  SolveOptions options;
  options.method = Method::cg;
  options.tolerance = 1e-12;

  const auto report = solve(transport, PatchField::Constant(50, 3, 0.999),
                            test::random_scene(50, 3, 0, 1, 67).second, options)
                          .report;

  EXPECT_TRUE(report.converged);
  EXPECT_LE(report.iterations, 2);
}

TEST(SolveCg, BearsReflectancesThatAreNearlyNothing) {
  const auto transport = test::random_enclosure(30, 68);
  auto [reflectance, emission] = test::random_scene(30, 1, 0.3, 0.9, 69);
  reflectance(4, 0) = 1e-20;
  reflectance(5, 0) = 1e-308;

  for (const Method method : test::all_methods) {
    SolveOptions options;
    options.method = method;
    options.tolerance = 1e-10;
    const auto solution = solve(transport, reflectance, emission, options);

    EXPECT_TRUE(solution.report.converged) << name(method) << solution.report.message;
    EXPECT_LT(test::largest_error(solution.radiosity, test::exact(transport, reflectance, emission)), 1e-9);
  }
}

}  // namespace
}  // namespace luxel
