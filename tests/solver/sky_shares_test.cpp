#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "luxel/dense_operator.h"
#include "luxel/enclosures.h"
#include "luxel/form_factors.h"
#include "solver/blocked_scenes.h"
#include "solver/hand_made_mesh.h"

namespace luxel {
namespace {

using testing::SceneBuilder;
using testing::turned;

FormFactors with_sky(const PatchMesh& mesh, double accuracy) {
  FormFactorOptions options;
  options.accuracy = accuracy;
  options.precision = Precision::float64;
  options.sky_shares = true;
  return form_factors(mesh, options);
}

/// A floor under the sky with two turned boxes floating over it, of which no back is in sight.
PatchMesh yard(int floor_cells, int box_cells) {
  SceneBuilder scene;
  scene.placement.rotate(turned(0.2, -0.5, 0.9));
  scene.quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, floor_cells);
  scene.box({0.15, 0.2, 0.2}, {0.45, 0.45, 0.7}, turned(0.3, 0.1, 0.7), box_cells, false);
  scene.box({0.55, 0.5, 0.3}, {0.85, 0.8, 0.7}, turned(-0.2, 0.2, 1.1), box_cells, false);
  return scene.take();
}

// Howell C-11 and C-14: a unit square opposite the opening of a cube sees 0.199825 of it, one beside it
// 0.200044
TEST(SkyShares, AreWhatABoxWithoutLidLosesThroughIt) {
  testing::Boxes box = testing::Boxes().add({0, 0, 0}, {1, 1, 1}, true);
  box.faces.erase(box.faces.begin() + 1);

  for (const double accuracy : {1e-3, 1e-5}) {
    const std::vector<double> shares = with_sky(box.mesh(), accuracy).sky_shares;

    ASSERT_EQ(shares.size(), 5u);
    // the figures have six digits
    EXPECT_NEAR(shares[0], 0.199825, accuracy + 5e-7);
    for (int i = 1; i < 5; ++i) EXPECT_NEAR(shares[i], 0.200044, accuracy + 5e-7);
  }
}

TEST(SkyShares, AndRowsAddUpToOneToTheAccuracyAsked) {
  const PatchMesh mesh = yard(8, 3);
  for (const double accuracy : {3e-2, 1e-2, 1e-3, 1e-4}) {
    const FormFactors found = with_sky(mesh, accuracy);

    ASSERT_EQ(found.exchange_areas.size(), mesh.size());
    const std::vector<double> rows = row_sums(found.exchange_areas, mesh.areas);
    double squares = 0, total = 0;
    for (int i = 0; i < mesh.size(); ++i) {
      const double error = rows[i] + found.sky_shares[i] - 1;
      EXPECT_LE(std::abs(error), 2 * accuracy) << "patch " << i << " at " << accuracy;
      squares += mesh.areas[i] * error * error;
      total += mesh.areas[i];
    }
    EXPECT_LE(std::sqrt(squares / total), accuracy);
  }
}

// A sheet with two sides between two squares: its sides lie in one plane, and one of them in one cluster with
// what faces the other. They exchange nothing.
TEST(SkyShares, AndRowsAddUpToOneAroundASheetWithTwoSides) {
  SceneBuilder scene;
  scene.quad({-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0}, 1);
  scene.quad({-0.5, -0.5, 1}, {-0.5, 0.5, 1}, {0.5, 0.5, 1}, {0.5, -0.5, 1}, 1);
  scene.quad({-0.25, -0.25, 0.5}, {0.25, -0.25, 0.5}, {0.25, 0.25, 0.5}, {-0.25, 0.25, 0.5}, 1, 2);
  const PatchMesh mesh = scene.take();

  const FormFactors found = with_sky(mesh, 1e-6);

  EXPECT_EQ(found.exchange_areas(2, 3), 0);
  const std::vector<double> rows = row_sums(found.exchange_areas, mesh.areas);
  for (int i = 0; i < mesh.size(); ++i) EXPECT_NEAR(rows[i] + found.sky_shares[i], 1, 2e-6) << i;
}

TEST(SkyShares, LeaveTheFactorsBetweenPatchesAsTheyAre) {
  const PatchMesh mesh = yard(4, 2);
  FormFactorOptions options;
  options.accuracy = 1e-5;
  options.precision = Precision::float64;

  const FormFactors without = form_factors(mesh, options), found = with_sky(mesh, 1e-5);

  EXPECT_TRUE(without.sky_shares.empty());
  EXPECT_EQ(found.report.pairs, without.report.pairs);
  for (int i = 0; i < mesh.size(); ++i) {
    for (int j = 0; j < i; ++j) {
      // each may err by the accuracy of a pair, A sqrt(G A_i), or by A of itself
      const double exchange = without.exchange_areas(i, j), smaller = std::min(mesh.areas[i], mesh.areas[j]);
      EXPECT_NEAR(found.exchange_areas(i, j), exchange, 2e-5 * std::sqrt(exchange * smaller) + 1e-12);
    }
  }
}

Enclosures one_open_enclosure(int size) {
  Enclosures open;
  open.count = 1;
  open.enclosure.assign(size, 0);
  open.enclosure_closed = {0};
  open.open_share.assign(size, 0.5);
  open.back_share.assign(size, 0.0);
  open.share_error.assign(size, 0.01);
  open.share_rays.assign(size, 256);
  return open;
}

TEST(TakeSkyShares, KeepsWhatIsClosedOrSeesBacksOrWasNotAssembled) {
  Enclosures found = one_open_enclosure(5);
  found.count = 3;
  found.enclosure = {0, 1, 2, 2, 0};
  found.enclosure_closed = {0, 1, 0};
  found.back_share[2] = 0.1;  // and so patch 3 may see a back too

  take_sky_shares(found, {0.25, 0.25, 0.25, 0.25, std::numeric_limits<double>::quiet_NaN()}, 1e-3);

  EXPECT_EQ(found.open_share, (std::vector<double>{0.25, 0.5, 0.5, 0.5, 0.5}));
  EXPECT_EQ(found.share_rays, (std::vector<int>{0, 256, 256, 256, 256}));
  EXPECT_LT(found.share_error[0], 1e-3);
  EXPECT_THROW(take_sky_shares(found, {0.25}, 1e-3), std::invalid_argument);
}

// Independent rays are what the bound holds for; nets do better. 20,000 rows that are right to the bit must
// not have one among them that is called wrong, for shares from rare to usual.
TEST(LargestByChance, IsNotExceededByAnyOfManyRightRows) {
  constexpr int size = 20'000, rays = 256;
  std::mt19937_64 random(3);
  for (const double share : {0.002, 0.02, 0.3, 0.5}) {
    std::binomial_distribution<int> met(rays, share);
    Enclosures found = one_open_enclosure(size);
    for (double& open : found.open_share) open = static_cast<double>(met(random)) / rays;
    int wrong = 0;
    for (int i = 0; i < size; ++i)
      wrong += std::abs(found.open_share[i] - share) > largest_by_chance(found, i);
    EXPECT_EQ(wrong, 0) << share;
  }
}

TEST(LargestByChance, IsExceededByARowThatLostAPatch) {
  const PatchMesh mesh = yard(8, 3);
  constexpr double accuracy = 1e-3;
  FormFactors factors = with_sky(mesh, accuracy);
  Enclosures found = find_enclosures(mesh, RayScene(mesh.occluders));
  take_sky_shares(found, factors.sky_shares, accuracy);
  const auto beyond = [&](int i) {
    const double row = row_sums(factors.exchange_areas, mesh.areas)[i];
    return std::abs(row + found.open_share[i] + found.back_share[i] - 1) - largest_by_chance(found, i);
  };
  for (int i = 0; i < mesh.size(); ++i) ASSERT_LE(beyond(i), 0);
  // an entry of some hundredths of a row
  int from = 0, to = 0;
  for (int i = 0; i < mesh.size(); ++i) {
    for (int j = 0; j < i; ++j) {
      const double share = factors.exchange_areas(i, j) / mesh.areas[i];
      if (share > 0.02 && share < 0.03) from = i, to = j;
    }
  }
  ASSERT_NE(from, to);

  factors.exchange_areas.set(from, to, 0);

  EXPECT_GT(beyond(from), 2 * accuracy);
}

}  // namespace
}  // namespace luxel
