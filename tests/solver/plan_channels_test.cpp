#include <gtest/gtest.h>

#include "luxel/plan.h"

namespace luxel {
namespace {

const std::vector<char> none_lossless{0, 0, 0};

PatchField grey(double value) {
  return PatchField::Constant(4, 3, value);
}

/// Emission of the first patch only.
PatchField lamp(double red, double green, double blue) {
  PatchField emission = PatchField::Zero(4, 3);
  emission.row(0) << red, green, blue;
  return emission;
}

TEST(PlanChannels, SolveAGreyRoomOnceWhateverTheColourOfItsLamp) {
  const ChannelPlan plan = plan_channels(grey(0.7), lamp(10, 8, 6), none_lossless);

  EXPECT_EQ(plan.solved, std::vector<int>{0});
  EXPECT_EQ(plan.source, (std::vector<int>{0, 0, 0}));
  EXPECT_EQ(plan.factors[0], 1);
  EXPECT_DOUBLE_EQ(plan.factors[1], 0.8);
  EXPECT_DOUBLE_EQ(plan.factors[2], 0.6);
}

TEST(PlanChannels, LeaveChannelsWithoutEmissionAtZero) {
  const ChannelPlan plan = plan_channels(grey(0.7), lamp(0, 8, 0), none_lossless);

  EXPECT_EQ(plan.solved, std::vector<int>{1});
  EXPECT_EQ(plan.source, (std::vector<int>{-1, 0, -1}));
}

TEST(PlanChannels, SolveAChannelThatEmitsHoweverLittle) {
  const ChannelPlan plan = plan_channels(grey(0.7), lamp(1, 1e-300, 0), none_lossless);

  EXPECT_GE(plan.source[1], 0);
  EXPECT_DOUBLE_EQ(plan.factors[1], 1e-300);
}

TEST(PlanChannels, SolveChannelsWhoseReflectanceDiffersByATrillionth) {
  PatchField reflectance = grey(0.7);
  reflectance(2, 1) += 1e-12;

  const ChannelPlan plan = plan_channels(reflectance, lamp(1, 1, 1), none_lossless);

  EXPECT_EQ(plan.solved, (std::vector<int>{0, 1}));
  EXPECT_EQ(plan.source, (std::vector<int>{0, 1, 0}));
}

TEST(PlanChannels, SolveChannelsWhoseLampsAreNotInProportion) {
  PatchField emission = lamp(1, 2, 3);
  emission.row(3) << 1, 2 * (1 + 1e-12), 3;

  const ChannelPlan plan = plan_channels(grey(0.7), emission, none_lossless);

  EXPECT_EQ(plan.source, (std::vector<int>{0, 1, 0}));
}

TEST(PlanChannels, SolveALampThatOnlyOneChannelHas) {
  PatchField emission = lamp(1, 1, 1);
  emission(3, 2) = 1e-12;

  const ChannelPlan plan = plan_channels(grey(0.7), emission, none_lossless);

  EXPECT_EQ(plan.source, (std::vector<int>{0, 0, 1}));
}

TEST(PlanChannels, KeepChannelsThatNothingAbsorbsToHaveThemRefused) {
  const ChannelPlan plan = plan_channels(grey(1), lamp(0, 0, 0), {0, 1, 0});

  EXPECT_EQ(plan.solved, std::vector<int>{1});
}

}  // namespace
}  // namespace luxel
