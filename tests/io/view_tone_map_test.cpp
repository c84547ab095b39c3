#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

#include "luxel/tone_map.h"

namespace luxel {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(ToneMap, EncodesSrgbAsTheStandardSays) {
  // IEC 61966-2-1: 0.214041140 is the linear value of 0.5
  EXPECT_NEAR(srgb_encoded(0.21404114), 0.5, 1e-8);
  EXPECT_NEAR(srgb_encoded(0.001), 0.01292, 1e-15);
  EXPECT_EQ(srgb_encoded(-1), 0);
  EXPECT_EQ(srgb_encoded(2), 1);
}

TEST(ToneMap, IsStraightBelowTheShoulder) {
  const ToneMap tone_map{.exposure = 2};

  const Rgb colour = tone_map.linear(Rgb(0.25, 0.2, 0.1));

  // one division and two products from the exact values
  EXPECT_TRUE(colour.isApprox(Rgb(0.5, 0.4, 0.2), 1e-15)) << colour.transpose();
}

TEST(ToneMap, GrowsWithRadianceAndStaysBelowOne) {
  const ToneMap tone_map;
  double last = 0;
  for (double value = 0.01; value < 3; value *= 1.1) {
    const double mapped = tone_map.linear(Rgb::Constant(value))[0];

    EXPECT_GT(mapped, last);
    EXPECT_LT(mapped, 1);
    last = mapped;
  }
}

TEST(ToneMap, HasNoKinkAtTheEndOfItsStraightPart) {
  constexpr double step = 1e-4;
  const auto slope = [](double at) {
    return (ToneMap().linear(Rgb::Constant(at + step)) - ToneMap().linear(Rgb::Constant(at)))[0] / step;
  };

  EXPECT_NEAR(slope(0.6 - step), 1, 1e-9);
  // the curve's second derivative is -1 / 0.4 there: half a step of it
  EXPECT_NEAR(slope(0.6), 1 - step / 0.8, 1e-7);
}

TEST(ToneMap, ALampOfAnyStrengthIsWhite) {
  EXPECT_EQ(ToneMap()(Rgb(17e3, 12e3, 4e3)), (std::array<std::uint8_t, 3>{255, 255, 255}));
}

TEST(ToneMap, NegativeChannelsAndNanAreBlack) {
  EXPECT_EQ(ToneMap()(Rgb(-1, std::numeric_limits<double>::quiet_NaN(), infinity)),
            (std::array<std::uint8_t, 3>{0, 0, 255}));
}

TEST(ToneMapFor, PutsTheBrightOnesAtTheEndOfTheStraightPart) {
  std::vector<double> luminances(100, 10);
  for (int i = 0; i < 9; ++i) luminances[i] = 1000;  // lamps: fewer than a tenth

  EXPECT_DOUBLE_EQ(tone_map_for(luminances).exposure, 0.06);
}

TEST(ToneMapFor, KeepsTheMedianVisible) {
  std::vector<double> luminances(80, 0.01);
  luminances.resize(100, 10);

  EXPECT_DOUBLE_EQ(tone_map_for(luminances).exposure, 5);
}

TEST(ToneMapFor, WeighsByArea) {
  EXPECT_DOUBLE_EQ(tone_map_for(std::vector<double>{2, 1}, std::vector<double>{0.01, 1}).exposure, 0.6);
}

TEST(ToneMapFor, LeavesOutWhatIsDarkOrNotANumber) {
  EXPECT_DOUBLE_EQ(tone_map_for(std::vector<double>{0, 0, 0, infinity, 2}).exposure, 0.3);
  EXPECT_EQ(tone_map_for(std::vector<double>{0, 0}).exposure, 1);
  EXPECT_EQ(tone_map_for({}).exposure, 1);
}

TEST(ToneMapFor, RefusesAnotherNumberOfWeights) {
  EXPECT_THROW(tone_map_for(std::vector<double>{1, 2}, std::vector<double>{1}), std::invalid_argument);
}

}  // namespace
}  // namespace luxel
