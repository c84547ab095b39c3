#include "linear/iteration_watch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "solver/solve_scenes.h"

namespace luxel {
namespace {

using test::MatrixOperator;

bool mentions(const SolveReport& report, std::string_view words) {
  return report.message.find(words) != std::string::npos;
}

SolveReport solve_duplicate_floor(Method method, double rho) {
  SolveOptions options;
  options.method = method;
  return solve(test::cube_with_duplicate_floor(), PatchField::Constant(7, 1, rho), PatchField::Ones(7, 1),
               options)
      .report;
}

// The spectral radius of F is 1.148331, so that the series diverges from rho = 0.870829 on.
TEST(IterationWatch, NoticesDivergenceWithinAFewIterations) {
  for (const Method method :
       {Method::neumann, Method::gauss_seidel, Method::symmetric_gauss_seidel, Method::southwell}) {
    const auto just_above = solve_duplicate_floor(method, 0.871);
    const auto above = solve_duplicate_floor(method, 0.95);

    EXPECT_EQ(just_above.stopped, Stopped::diverged) << name(method);
    EXPECT_EQ(above.stopped, Stopped::diverged) << name(method);
    EXPECT_LE(above.iterations, 12) << name(method);
    EXPECT_LE(just_above.iterations, 20) << name(method);
    EXPECT_FALSE(above.converged);
    EXPECT_TRUE(mentions(above, "1.14")) << above.message;  // 1.2 x 0.95
    EXPECT_TRUE(mentions(above, "iteration")) << above.message;
  }
}

TEST(IterationWatch, DoesNotTakeSlowConvergenceForDivergence) {
  for (const Method method :
       {Method::neumann, Method::gauss_seidel, Method::symmetric_gauss_seidel, Method::southwell}) {
    const auto report = solve_duplicate_floor(method, 0.86);

    EXPECT_TRUE(report.converged) << name(method) << ": " << report.message;
  }
}

TEST(IterationWatch, ConjugateGradientsAndCholeskySeeThatTheSystemIsNotDefinite) {
  for (const Method method : {Method::cg, Method::cholesky}) {
    const auto report = solve_duplicate_floor(method, 0.9);

    EXPECT_EQ(report.stopped, Stopped::diverged) << name(method);
    EXPECT_TRUE(mentions(report, "returns more light than it is given")) << report.message;
  }
}

TEST(IterationWatch, RefusesNegativeLightBeyondTheSpectralRadius) {
  // rho F has spectral radius 1.033: the equations have a solution, which is no light
  for (const Method method : {Method::lu, Method::gmres}) {
    const auto report = solve_duplicate_floor(method, 0.9);

    EXPECT_FALSE(report.converged) << name(method);
    EXPECT_EQ(report.stopped, Stopped::diverged) << name(method);
    EXPECT_TRUE(mentions(report, "negative radiosities")) << report.message;
  }
}

TEST(IterationWatch, LetsSlowIterationsGoOnBehindTheHumpOfTheirFirst) {
  // at reflectance 0.9999 the residual rises for a few sweeps and then falls by 1e-4 each
  SolveOptions options;
  options.tolerance = 1e-2;
  options.max_iterations = 100'000;
  for (const Method method : {Method::neumann, Method::gauss_seidel, Method::southwell}) {
    options.method = method;
    const auto report =
        solve(test::cube6(), PatchField::Constant(6, 1, 0.9999), PatchField::Ones(6, 1), options).report;

    EXPECT_TRUE(report.converged) << name(method) << ": " << report.message;
  }
}

TEST(IterationWatch, NoticesThatTheResidualIsNotANumber) {
  Eigen::MatrixXd rows = test::cube6().rows();
  rows(2, 3) = std::nan("");
  const MatrixOperator transport(rows, Eigen::VectorXd::Ones(6));

  for (const Method method : {Method::neumann, Method::gmres}) {
    SolveOptions options;
    options.method = method;
    const auto report =
        solve(transport, PatchField::Constant(6, 1, 0.5), PatchField::Ones(6, 1), options).report;

    EXPECT_EQ(report.stopped, Stopped::diverged) << name(method);
    EXPECT_TRUE(mentions(report, "not a number")) << report.message;
    EXPECT_FALSE(report.converged);
  }
}

TEST(IterationWatch, NoticesStagnationAtRounding) {
  for (const Method method : test::all_methods) {
    SolveOptions options;
    options.method = method;
    options.tolerance = 1e-30;
    options.max_iterations = 1'000'000;
    const auto transport = test::random_enclosure(40, 41);
    const auto [reflectance, emission] = test::random_scene(40, 2, 0.8, 0.95, 42);

    const auto report = solve(transport, reflectance, emission, options).report;

    EXPECT_FALSE(report.converged) << name(method);
    EXPECT_EQ(report.stopped, Stopped::stagnated) << name(method);
    EXPECT_LT(report.relative_residual, 1e-13) << name(method);
    EXPECT_FALSE(report.message.empty());
  }
}

}  // namespace
}  // namespace luxel
