#include <gtest/gtest.h>

#include <cmath>

#include "solver/solve_scenes.h"

namespace luxel {
namespace {

TEST(SolveNeumann, TermKHoldsTheLightOfKBounces) {
  const auto transport = test::random_enclosure(40, 51);
  SolveOptions options;
  options.method = Method::neumann;
  for (const double rho : {0.5, 0.9, 0.999}) {
    for (const int bounces : {0, 1, 7, 100}) {
      options.bounces = bounces;

      const auto solution =
          solve(transport, PatchField::Constant(40, 3, rho), PatchField::Constant(40, 3, 3), options);

      const double expected = 3 * (1 - std::pow(rho, bounces + 1)) / (1 - rho);
      EXPECT_LT((solution.radiosity.array() / expected - 1).abs().maxCoeff(), 1e-12) << rho << " " << bounces;
      EXPECT_EQ(solution.report.iterations, bounces);
      EXPECT_EQ(solution.report.stopped, Stopped::bounces);
    }
  }
}

TEST(SolveNeumann, HandsOverTheLightOfEachBounce) {
  SolveOptions options;
  options.method = Method::neumann;
  options.bounces = 5;
  std::vector<double> light;
  options.on_iteration = [&](const Iteration& iteration) {
    light.push_back((*iteration.radiosity)(3, 0));
    return true;
  };

  solve(test::cube6(), PatchField::Constant(6, 1, 0.5), PatchField::Ones(6, 1), options);

  ASSERT_EQ(light.size(), 6u);
  for (int k = 0; k <= 5; ++k) EXPECT_NEAR(light[k], 2 * (1 - std::pow(0.5, k + 1)), 1e-14);
}

TEST(SolveNeumann, ResidualFallsByTheReflectance) {
  SolveOptions options;
  options.method = Method::neumann;
  options.tolerance = 1e-6;

  const auto report =
      solve(test::cube6(), PatchField::Constant(6, 1, 0.8), PatchField::Ones(6, 1), options).report;

  // the residual of bounce k is rho^(k + 1) E
  for (const Iteration& iteration : report.history) {
    EXPECT_NEAR(iteration.relative_residual, std::pow(0.8, iteration.number + 1), 1e-14);
  }
  EXPECT_EQ(report.iterations, static_cast<int>(std::ceil(std::log(1e-6) / std::log(0.8))) - 1);
}

}  // namespace
}  // namespace luxel
