#include <gtest/gtest.h>

#include "solver/solve_scenes.h"

namespace luxel {
namespace {

using test::MatrixOperator;

std::string refusal(const MatrixOperator& transport, const PatchField& reflectance,
                    const PatchField& emission, Method method = Method::automatic) {
  SolveOptions options;
  options.method = method;
  try {
    solve(transport, reflectance, emission, options);
  } catch (const SingularSystem& refused) {
    return refused.what();
  }
  return {};
}

TEST(SolveSingular, RefusesAWhiteClosedEnclosureByEveryMethod) {
  const auto transport = test::random_enclosure(30, 31);

  for (const Method method : test::all_methods) {
    const auto message = refusal(transport, PatchField::Ones(30, 1), PatchField::Ones(30, 1), method);
    EXPECT_NE(message.find("the enclosure of patch 0"), std::string::npos) << name(method);
    EXPECT_NE(message.find("emission"), std::string::npos) << message;
  }
}

TEST(SolveSingular, NamesTheEnclosureByItsFirstPatch) {
  const auto transport = test::side_by_side(test::random_enclosure(12, 32), test::random_enclosure(9, 33));
  PatchField reflectance = PatchField::Constant(21, 1, 0.5), emission = PatchField::Zero(21, 1);
  reflectance.bottomRows(9).setOnes();
  emission.topRows(12).setOnes();

  const auto message = refusal(transport, reflectance, emission);

  EXPECT_NE(message.find("the enclosure of patch 12"), std::string::npos) << message;
  EXPECT_NE(message.find("not unique"), std::string::npos) << message;
}

TEST(SolveSingular, NamesTheChannel) {
  const auto transport = test::random_enclosure(12, 34);
  PatchField reflectance = PatchField::Constant(12, 3, 0.5);
  reflectance.col(2).setOnes();

  EXPECT_NE(refusal(transport, reflectance, PatchField::Ones(12, 3)).find("channel 2"), std::string::npos);
}

TEST(SolveSingular, RefusesWithoutEmissionToo) {
  EXPECT_FALSE(refusal(test::cube6(), PatchField::Ones(6, 1), PatchField::Zero(6, 1)).empty());
}

TEST(SolveSingular, SolvesWithOneAbsorber) {
  const auto transport = test::cube6();
  PatchField reflectance = PatchField::Ones(6, 1), emission = PatchField::Zero(6, 1);
  reflectance(0, 0) = 0.25;
  emission(1, 0) = 1;

  const auto solution = solve(transport, reflectance, emission);

  // all that is emitted is absorbed by patch 0, so that its irradiance is 1 / 0.75
  EXPECT_TRUE(solution.report.converged);
  EXPECT_NEAR(solution.irradiance(0, 0), 1 / 0.75, 1e-5);
}

TEST(SolveSingular, SolvesWithAnAbsorberThatIsFarAway) {
  // a chain of 40 patches, each seeing its two neighbours only, black at one end
  Eigen::MatrixXd exchange = Eigen::MatrixXd::Zero(40, 40);
  for (int i = 0; i + 1 < 40; ++i) exchange(i, i + 1) = exchange(i + 1, i) = 0.5;
  exchange(0, 0) = exchange(39, 39) = 0.5;
  const auto transport = MatrixOperator::from_exchange_areas(exchange, Eigen::VectorXd::Ones(40));
  PatchField reflectance = PatchField::Ones(40, 1), emission = PatchField::Zero(40, 1);
  reflectance(39, 0) = 0;
  emission(0, 0) = 1;
  SolveOptions options;
  options.tolerance = 1e-12;

  const auto solution = solve(transport, reflectance, emission, options);

  // one unit flows down the chain: H falls by 2 from patch to patch and is 1 at the black end, B its
  // neighbour's 2
  EXPECT_NEAR(solution.irradiance(39, 0), 1, 1e-9);
  EXPECT_NEAR(solution.radiosity(38, 0), 2, 1e-9);
  EXPECT_NEAR(solution.radiosity(0, 0), 78, 1e-7);
}

TEST(SolveSingular, SolvesAWhiteOpenScene) {
  const auto solution = solve(test::two_plates(), PatchField::Ones(2, 1), PatchField::Ones(2, 1));

  EXPECT_NEAR(solution.radiosity(0, 0), 1 / (1 - 0.199824895698387), 1e-6);
}

TEST(SolveSingular, CountsBouncesWithoutAsking) {
  SolveOptions options;
  options.bounces = 4;

  const auto solution = solve(test::cube6(), PatchField::Ones(6, 1), PatchField::Ones(6, 1), options);

  // each bounce of a white furnace brings 1 more
  EXPECT_NEAR(solution.radiosity(2, 0), 5, 1e-13);
}

}  // namespace
}  // namespace luxel
