#include "form_factors/ray_visibility.h"

#include <gtest/gtest.h>

#include <cmath>

#include "form_factors/hidden_pair.h"
#include "form_factors/shaft.h"
#include "luxel/form_factors.h"
#include "solver/blocked_scenes.h"

namespace luxel {
namespace {

struct Partial {
  RayPair pair;
  double visible;  // share, by clipping
};

// Every `stride`-th pair of a room with turned boxes that is partly hidden, with its visible share to 1e-7.
std::vector<Partial> partial_pairs(const PatchMesh& mesh, const ClusterTree& tree, const OccluderSet& set,
                                   int stride) {
  HiddenPair clip(mesh, tree, set);
  const auto all = all_candidates(set);
  std::vector<Partial> pairs;
  int met = 0;
  for (int s = 0; s < mesh.size(); ++s) {
    for (int t = 0; t < s; ++t) {
      const WorkPatch &a = tree.patches[s], &b = tree.patches[t];
      const ShaftEnd from = shaft_end(a.outline, a.centroid, a.edge),
                     to = shaft_end(b.outline, b.centroid, b.edge);
      const ShaftCandidates found = candidates_in_shaft(from, to, set, all);
      if (found.hidden || found.list.empty() || ++met % stride != 0) continue;
      const double exchange =
          exchange_area(std::span(a.outline.corners.data(), static_cast<std::size_t>(a.outline.count)),
                        std::span(b.outline.corners.data(), static_cast<std::size_t>(b.outline.count)));
      if (!(exchange > 0)) continue;
      const HiddenPart hidden = clip(s, t, found.list, exchange, 1e-7 * exchange);
      pairs.push_back({{s, t, exchange, 2e-3 * exchange}, 1 - hidden.value / exchange});
    }
  }
  return pairs;
}

TEST(RayVisibility, AgreesWithClippingWithoutBias) {
  const PatchMesh mesh = testing::room_with_turned_boxes(6, 3);
  const ClusterTree tree = cluster_tree(mesh);
  const OccluderSet set = occluder_set(mesh, tree);
  const std::vector<Partial> partial = partial_pairs(mesh, tree, set, 37);
  ASSERT_GT(partial.size(), 100u);
  std::vector<RayPair> pairs;
  for (const Partial& p : partial) pairs.push_back(p.pair);

  const std::vector<RayShare> shares = RayVisibility(tree, OccluderScene(set), 1).visible(pairs);

  double bias = 0, squares = 0, largest = 0;
  for (std::size_t k = 0; k < shares.size(); ++k) {
    const double error = shares[k].visible - partial[k].visible;
    bias += error / static_cast<double>(shares.size());
    squares += error * error / static_cast<double>(shares.size());
    largest = std::max(largest, std::abs(error));
  }
  // asked for 2e-3 a pair; the mean of so many independent errors is below four of its standard errors
  EXPECT_LT(std::sqrt(squares), 2e-3);
  EXPECT_LT(largest, 1.2e-2);
  EXPECT_LT(std::abs(bias), 4 * 2e-3 / std::sqrt(static_cast<double>(shares.size())));
}

// Standard error of a mean of n shares that are 0 or 1 with chance p: at most sqrt(p (1 - p) / n). Nets of
// two and four points do better.
TEST(RayVisibility, IsUnbiasedWhereOneRayIsEnough) {
  const PatchMesh mesh = testing::room_with_turned_boxes(6, 3);
  const ClusterTree tree = cluster_tree(mesh);
  const OccluderSet set = occluder_set(mesh, tree);
  const std::vector<Partial> partial = partial_pairs(mesh, tree, set, 37);
  const OccluderScene scene(set);
  constexpr int seeds = 40;
  for (const double tolerance : {1.0, 0.3}) {
    std::vector<RayPair> pairs;
    for (const Partial& p : partial) {
      pairs.push_back(p.pair);
      pairs.back().tolerance = tolerance * p.pair.unhidden;
    }
    double bias = 0, variance = 0;
    std::int64_t rays = 0;
    for (int seed = 0; seed < seeds; ++seed) {
      const std::vector<RayShare> shares = RayVisibility(tree, scene, seed).visible(pairs);
      for (std::size_t k = 0; k < shares.size(); ++k) {
        bias += shares[k].visible - partial[k].visible;
        variance += partial[k].visible * (1 - partial[k].visible);
        rays += shares[k].rays;
      }
    }
    EXPECT_LT(std::abs(bias), 4 * std::sqrt(variance)) << tolerance;
    // some near pairs, whose rays weigh unlike, need twice as many
    const double planned =
        static_cast<double>(first_rays(tolerance)) * seeds * static_cast<double>(pairs.size());
    EXPECT_LE(static_cast<double>(rays), 1.05 * planned) << tolerance;
  }
}

TEST(FirstRays, AreAsFewAsTheToleranceAllows) {
  EXPECT_EQ(first_rays(1), 1);
  EXPECT_EQ(first_rays(1e-3), most_first_rays);
  for (double tolerance = 1; tolerance > worst_share_error(most_first_rays); tolerance *= 0.9) {
    const int rays = first_rays(tolerance);
    EXPECT_LE(worst_share_error(rays), tolerance);
    if (rays > 1) {
      EXPECT_GT(worst_share_error(rays / 2), tolerance);
    }
  }
}

TEST(RayVisibility, DependsOnTheSeedAndThePairAlone) {
  const PatchMesh mesh = testing::room_with_turned_boxes(4, 2);
  const ClusterTree tree = cluster_tree(mesh);
  const OccluderSet set = occluder_set(mesh, tree);
  std::vector<RayPair> pairs;
  for (const Partial& p : partial_pairs(mesh, tree, set, 29)) pairs.push_back(p.pair);
  const OccluderScene scene(set);
  const RayVisibility rays(tree, scene, 5), others(tree, scene, 6);

  const auto together = rays.visible(pairs), different = others.visible(pairs);

  bool differs = false;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto alone = rays.visible(std::span(&pairs[k], 1));
    EXPECT_EQ(alone[0].visible, together[k].visible);
    EXPECT_EQ(alone[0].rays, together[k].rays);
    differs |= different[k].visible != together[k].visible;
  }
  EXPECT_TRUE(differs);
}

}  // namespace
}  // namespace luxel
