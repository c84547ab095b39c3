#include "luxel/solve.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <vector>

#include "solver/solve_scenes.h"

namespace luxel {
namespace {

using test::all_methods;
using test::column;
using test::exact;
using test::MatrixOperator;
using test::random_scene;

class EveryMethod : public testing::TestWithParam<Method> {
 protected:
  SolveOptions options(double tolerance) const {
    SolveOptions options;
    options.method = GetParam();
    options.tolerance = tolerance;
    options.max_iterations = 200'000;
    return options;
  }
};

INSTANTIATE_TEST_SUITE_P(Solve, EveryMethod, testing::ValuesIn(all_methods),
                         [](const auto& method) { return test::test_name(method.param); });

TEST_P(EveryMethod, SolvesTheWhiteFurnace) {
  const auto transport = test::random_enclosure(60, 1);
  for (const double rho : {0.5, 0.9, 0.999}) {
    const PatchField reflectance = PatchField::Constant(60, 3, rho);
    const PatchField emission = PatchField::Constant(60, 3, 2);

    const auto solution = solve(transport, reflectance, emission, options(1e-12));

    EXPECT_TRUE(solution.report.converged) << rho << ": " << solution.report.message;
    // the row sums are 1 to 1e-15, which 1 / (1 - rho) magnifies; the residual adds 1e-12 / (1 - rho)
    const double tolerance = 4e-12 / (1 - rho);
    EXPECT_LT((solution.radiosity.array() * (1 - rho) / 2 - 1).abs().maxCoeff(), tolerance) << rho;
    EXPECT_LE(solution.report.relative_residual, 1e-12);
  }
}

TEST_P(EveryMethod, SolvesTheCubeOfSixPatches) {
  const auto transport = test::cube6();

  const auto a =
      solve(transport, column({0.2, 0.8, 0.5, 0.5, 0.5, 0.5}), column({0, 1, 0, 0, 0, 0}), options(1e-12));
  const auto high =
      solve(transport, PatchField::Constant(6, 1, 0.999), column({1, 0, 0, 0, 0, 0}), options(1e-13));

  // six-by-six system solved with 50 digits
  const double wall = 0.170406452563970, high_wall = 166.527784998906;
  const PatchField expected = column({0.0720558695573895, 1.12060284605824, wall, wall, wall, wall});
  const PatchField expected_high =
      column({167.361226893290, 166.527633111084, high_wall, high_wall, high_wall, high_wall});
  EXPECT_LT((a.radiosity - expected).cwiseQuotient(expected).cwiseAbs().maxCoeff(), 1e-11);
  // the factors carry 15 digits, which 1 / (1 - rho) = 1000 magnifies
  EXPECT_LT((high.radiosity - expected_high).cwiseQuotient(expected_high).cwiseAbs().maxCoeff(), 2e-11);
}

TEST_P(EveryMethod, SolvesTwoFacingPlates) {
  const auto solution =
      solve(test::two_plates(), PatchField::Constant(2, 1, 0.5), column({1, 0}), options(1e-13));

  // B1 = 1 / (1 - rho^2 F^2), B2 = rho F B1; 15 digits; the residual of 1e-13 is magnified by 1 / (1 - rho F)
  // = 1.1
  EXPECT_NEAR(solution.radiosity(0, 0), 1.01008315227492, 1.2e-13);
  EXPECT_NEAR(solution.radiosity(1, 0), 0.100919880275018, 1.2e-13);
  EXPECT_NEAR(solution.irradiance(1, 0), 0.199824895698387 * 1.01008315227492, 1.2e-13);
}

TEST_P(EveryMethod, GivesTheEmissionBitForBitWhereNothingReflects) {
  const auto transport = test::random_enclosure(50, 2);
  auto [reflectance, emission] = random_scene(50, 3, 0.1, 0.9, 3);
  reflectance.topRows(20).setZero();
  reflectance.col(1).setZero();

  const auto solution = solve(transport, reflectance, emission, options(1e-9));

  EXPECT_TRUE(solution.report.converged);
  EXPECT_EQ(solution.radiosity.topRows(20), emission.topRows(20));
  EXPECT_EQ(solution.radiosity.col(1), emission.col(1));
  EXPECT_GT(solution.radiosity(30, 0), emission(30, 0));
}

TEST_P(EveryMethod, GivesExactlyZeroWithoutEmission) {
  const auto transport = test::random_enclosure(50, 2);
  auto [reflectance, emission] = random_scene(50, 3, 0.1, 0.9, 3);
  emission.col(2).setZero();

  const auto dark = solve(transport, reflectance, PatchField::Zero(50, 3), options(1e-9));
  const auto one_dark = solve(transport, reflectance, emission, options(1e-9));

  EXPECT_TRUE(dark.report.converged);
  EXPECT_EQ(dark.radiosity, PatchField::Zero(50, 3));
  EXPECT_EQ(dark.report.relative_residual, 0);
  EXPECT_EQ(dark.report.error_bound, 0);
  EXPECT_TRUE(one_dark.report.converged);
  EXPECT_EQ(one_dark.radiosity.col(2), PatchField::Zero(50, 1));
}

TEST_P(EveryMethod, KeepsFaintLightBesideStrongLight) {
  const auto transport = test::side_by_side(test::random_enclosure(20, 4), test::random_enclosure(20, 5));
  const PatchField reflectance = PatchField::Constant(40, 1, 0.7);
  PatchField emission = PatchField::Zero(40, 1);
  emission(0, 0) = 1e12;
  emission(20, 0) = 1;

  const auto solution = solve(transport, reflectance, emission, options(1e-15));

  // the faint enclosure's residual is invisible beside 1e12, but it gets as many iterations; not so where the
  // most powerful patch shoots first
  const PatchField expected = exact(transport, reflectance, emission);
  const PatchField error = (solution.radiosity - expected).cwiseAbs();
  const bool sees_power_only = GetParam() == Method::southwell;
  EXPECT_LT(error.cwiseQuotient(expected).topRows(sees_power_only ? 20 : 40).maxCoeff(), 1e-9);
}

TEST_P(EveryMethod, DoesNotFlushATinyEmittersLight) {
  // 1 m2 at 1000 m above 1e12 m2: F12 with 15 digits, F21 = 1e-12 F12
  constexpr double f12 = 0.999996726771548;
  const auto transport = MatrixOperator::from_exchange_areas(
      (Eigen::MatrixXd(2, 2) << 0, f12, f12, 0).finished(), Eigen::Vector2d(1, 1e12));

  const auto solution = solve(transport, PatchField::Constant(2, 1, 0.5), column({1, 0}), options(1e-6));

  EXPECT_NEAR(solution.radiosity(1, 0) / 4.99998363385774e-13, 1, 1e-6);
}

TEST_P(EveryMethod, SolvesABlackAndWhiteCheckerboard) {
  const auto transport = test::random_enclosure(64, 6, Precision::float32);
  PatchField reflectance(64, 1), emission = PatchField::Zero(64, 1);
  for (int i = 0; i < 64; ++i) reflectance(i, 0) = i % 2 == 0 ? 0.9 : 0;
  emission.topRows(8).setOnes();

  const auto solution = solve(transport, reflectance, emission, options(1e-12));

  EXPECT_TRUE(solution.report.converged);
  // residual 1e-12 over the smallest loss of 0.1
  EXPECT_LT((solution.radiosity - exact(transport, reflectance, emission)).cwiseAbs().maxCoeff(), 1e-10);
}

TEST_P(EveryMethod, SolvesANestedBodyAMillionTimesSmaller) {
  // inner convex body of area 1e-12 in a sphere of area 1: F_io = 1, F_oi = 1e-12, F_oo = 1 - 1e-12
  const auto transport = MatrixOperator::from_exchange_areas(
      (Eigen::MatrixXd(2, 2) << 0, 1e-12, 1e-12, 1 - 1e-12).finished(), Eigen::Vector2d(1e-12, 1));

  const auto solution =
      solve(transport, PatchField::Constant(2, 1, 0.5), PatchField::Ones(2, 1), options(1e-12));

  EXPECT_NEAR(solution.radiosity(0, 0), 2, 1e-10);
  EXPECT_NEAR(solution.radiosity(1, 0), 2, 1e-10);
}

TEST_P(EveryMethod, SolvesThirtyRightHandSidesAtOnce) {
  const auto transport = test::random_enclosure(80, 7);
  for (const int m : {1, 3, 30}) {
    const auto [reflectance, emission] = random_scene(80, m, 0.2, 0.9, m);

    const auto solution = solve(transport, reflectance, emission, options(1e-11));

    EXPECT_TRUE(solution.report.converged) << solution.report.message;
    EXPECT_LT((solution.radiosity - exact(transport, reflectance, emission)).cwiseAbs().maxCoeff(), 1e-9);
    // sums of 80 numbers up to 1
    EXPECT_LT((solution.irradiance - transport.rows() * solution.radiosity).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST_P(EveryMethod, GivesTheSameBitsForAnyNumberOfThreads) {
  // more patches than a tile and a panel are wide
  const auto transport = test::random_enclosure(1300, 8, Precision::float32);
  const auto [reflectance, emission] = random_scene(1300, 3, 0.2, 0.9, 9);

  PatchField radiosity[2];
  for (const int threads : {1, 2}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    radiosity[threads - 1] = solve(transport, reflectance, emission, options(1e-8)).radiosity;
  }

  EXPECT_EQ(radiosity[0], radiosity[1]);
}

TEST_P(EveryMethod, ClosesTheEnergyBalance) {
  const auto closed = test::random_enclosure(70, 10);
  const auto open = MatrixOperator::from_exchange_areas(
      0.6 * Eigen::MatrixXd(closed.rows().array().colwise() *
                            Eigen::Map<const Eigen::ArrayXd>(closed.areas().data(), 70)),
      Eigen::Map<const Eigen::VectorXd>(closed.areas().data(), 70));
  const auto [reflectance, emission] = random_scene(70, 3, 0.2, 0.95, 11);

  const Energy in_closed =
      energy(closed, reflectance, emission, solve(closed, reflectance, emission, options(1e-12)));
  const Energy in_open =
      energy(open, reflectance, emission, solve(open, reflectance, emission, options(1e-12)));

  EXPECT_LT(in_closed.imbalance, 1e-10);
  EXPECT_LT(in_closed.escaped.cwiseAbs().maxCoeff(), 1e-12 * in_closed.emitted.maxCoeff());
  EXPECT_LT(in_open.imbalance, 1e-10);
  EXPECT_GT((in_open.escaped.array() / in_open.emitted.array()).minCoeff(), 0.3);
}

TEST_P(EveryMethod, ReachesTheTrueResidualAtHighReflectance) {
  const auto transport = test::random_enclosure(100, 12, Precision::float32);
  const auto [reflectance, emission] = random_scene(100, 3, 0.999, 0.999, 13);

  const auto solution = solve(transport, reflectance, emission, options(1e-10));

  EXPECT_TRUE(solution.report.converged) << solution.report.message;
  PatchField reflected(100, 3);
  transport.apply(solution.radiosity.data(), reflected.data(), 3);
  const PatchField residual = emission - solution.radiosity + reflectance.cwiseProduct(reflected);
  const Eigen::Map<const Eigen::VectorXd> areas(transport.areas().data(), 100);
  const auto norm = [&](const PatchField& x) {
    return (areas.transpose() * x.cwiseAbs2()).cwiseSqrt().eval();
  };
  EXPECT_LE(norm(residual).cwiseQuotient(norm(emission)).maxCoeff(), 1e-10);
}

TEST_P(EveryMethod, StopsWhenTheCallerSaysSo) {
  const auto transport = test::random_enclosure(50, 14);
  const auto [reflectance, emission] = random_scene(50, 1, 0.5, 0.9, 15);
  SolveOptions wanted = options(1e-12);
  std::vector<int> numbers;
  wanted.on_iteration = [&](const Iteration& iteration) {
    numbers.push_back(iteration.number);
    EXPECT_TRUE(!iteration.radiosity || iteration.radiosity->rows() == 50);
    return iteration.number < 1;
  };

  const auto solution = solve(transport, reflectance, emission, wanted);

  EXPECT_EQ(numbers, (std::vector{0, 1}));
  EXPECT_EQ(solution.report.stopped, Stopped::caller);
  EXPECT_FALSE(solution.report.converged);
  EXPECT_EQ(solution.report.history.size(), 2u);
}

TEST_P(EveryMethod, CountsIterationsOnceInItsHistory) {
  const auto transport = test::random_enclosure(50, 16);
  const auto [reflectance, emission] = random_scene(50, 3, 0.5, 0.95, 17);

  const auto report = solve(transport, reflectance, emission, options(1e-12)).report;

  for (std::size_t k = 0; k < report.history.size(); ++k) {
    EXPECT_EQ(report.history[k].number, static_cast<int>(k));
    EXPECT_EQ(report.history[k].radiosity, nullptr);
  }
  EXPECT_EQ(report.history.back().number, report.iterations);
  EXPECT_EQ(report.method, GetParam());
}

TEST_P(EveryMethod, SaysThatTheIterationsAreUsedUp) {
  const auto transport = test::random_enclosure(50, 18);
  const auto [reflectance, emission] = random_scene(50, 1, 0.99, 0.99, 19);
  SolveOptions wanted = options(1e-15);
  wanted.max_iterations = 2;

  const auto report = solve(transport, reflectance, emission, wanted).report;

  // direct methods reach rounding in two iterations, or say that they have met it
  EXPECT_LE(report.iterations, 2);
  EXPECT_EQ(report.converged, report.relative_residual <= 1e-15);
  EXPECT_EQ(report.converged, report.message.empty());
}

TEST_P(EveryMethod, LeavesAnUnlitEnclosureExactlyDark) {
  const auto transport = test::side_by_side(test::random_enclosure(20, 4), test::random_enclosure(20, 5));
  PatchField emission = PatchField::Zero(40, 1);
  emission.topRows(20).setOnes();

  const auto solution = solve(transport, PatchField::Constant(40, 1, 0.8), emission, options(1e-12));

  EXPECT_NEAR(solution.radiosity(0, 0), 5, 1e-10);
  EXPECT_EQ(solution.radiosity.bottomRows(20), PatchField::Zero(20, 1));
  EXPECT_EQ(solution.irradiance.bottomRows(20), PatchField::Zero(20, 1));
}

TEST_P(EveryMethod, ReachesTwelveDigitsInALargeWhiteFurnace) {
  // 1 / (1 - rho) = 1000 magnifies the rounding of sums of 1,500 numbers in float64
  const auto transport = test::random_enclosure(1500, 70, Precision::float32);
  const bool quick = GetParam() == Method::cg || GetParam() == Method::gmres ||
                     GetParam() == Method::cholesky || GetParam() == Method::lu;
  const double rho = quick ? 0.999 : 0.9;

  const auto solution =
      solve(transport, PatchField::Constant(1500, 1, rho), PatchField::Ones(1500, 1), options(1e-12));

  EXPECT_TRUE(solution.report.converged) << solution.report.message;
  // the row sums of the test's operator are 1 to sqrt(N) u, magnified by 1 / (1 - rho)
  EXPECT_LT((solution.radiosity.array() * (1 - rho) - 1).abs().maxCoeff(), 1e-11);
}

TEST(Solve, RefusesWhatTheCallerMayNotAsk) {
  const auto transport = test::cube6();
  const PatchField half = PatchField::Constant(6, 1, 0.5), ones = PatchField::Ones(6, 1);
  SolveOptions bounces;
  bounces.method = Method::cg;
  bounces.bounces = 3;
  SolveOptions no_tolerance;
  no_tolerance.tolerance = 0;

  EXPECT_THROW(solve(transport, PatchField::Ones(5, 1), ones), std::invalid_argument);
  EXPECT_THROW(solve(transport, half, PatchField::Ones(6, 2)), std::invalid_argument);
  EXPECT_THROW(solve(transport, 3 * half, ones), std::invalid_argument);
  EXPECT_THROW(solve(transport, half, -ones), std::invalid_argument);
  EXPECT_THROW(solve(transport, half, ones * std::nan("")), std::invalid_argument);
  EXPECT_THROW(solve(transport, half, ones, bounces), std::invalid_argument);
  EXPECT_THROW(solve(transport, half, ones, no_tolerance), std::invalid_argument);
}

TEST(Solve, RefusesMethodsThatTheOperatorDoesNotAllow) {
  const MatrixOperator rows(test::cube6().rows(), Eigen::VectorXd::Ones(6));
  const PatchField half = PatchField::Constant(6, 1, 0.5), ones = PatchField::Ones(6, 1);

  for (const Method method : all_methods) {
    SolveOptions options;
    options.method = method;
    if (method == Method::gmres || method == Method::neumann) {
      EXPECT_TRUE(solve(rows, half, ones, options).report.converged);
    } else {
      EXPECT_THROW(solve(rows, half, ones, options), std::invalid_argument) << name(method);
    }
  }
}

TEST(Solve, ChoosesAMethodThatFits) {
  const auto transport = test::random_enclosure(40, 20);
  const MatrixOperator rows(transport.rows(), Eigen::VectorXd::Ones(40));
  const PatchField reflectance = PatchField::Constant(40, 30, 0.5), emission = PatchField::Ones(40, 30);
  SolveOptions bounces;
  bounces.bounces = 2;

  EXPECT_EQ(solve(transport, reflectance.leftCols(3), emission.leftCols(3)).report.method, Method::cg);
  EXPECT_EQ(solve(transport, reflectance, emission).report.method, Method::cholesky);
  EXPECT_EQ(solve(rows, reflectance, emission).report.method, Method::gmres);
  EXPECT_EQ(solve(transport, reflectance, emission, bounces).report.method, Method::neumann);
}

TEST(Method, IsReadByItsName) {
  for (const Method method : all_methods) EXPECT_EQ(method_from_name(name(method)), method);
  EXPECT_EQ(method_from_name("auto"), Method::automatic);
  EXPECT_EQ(method_from_name("jacobi"), Method::neumann);
  EXPECT_EQ(method_from_name("sor"), std::nullopt);
}

}  // namespace
}  // namespace luxel
