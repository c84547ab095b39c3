#include "form_factors/block_sights.h"

#include <gtest/gtest.h>

#include <cmath>

#include "form_factors/hidden_pair.h"
#include "form_factors/shaft.h"
#include "luxel/form_factors.h"
#include "solver/blocked_scenes.h"

namespace luxel {
namespace {

// Two facing squares of 5 x 5 patches, and between them strips so that `share` of each place is covered.
struct Plates {
  PatchMesh mesh;
  ClusterTree tree;
  OccluderSet set;
  int a = -1, b = -1;  // clusters of the plates

  explicit Plates(double share) {
    testing::SceneBuilder scene;
    scene.quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, 5);
    scene.quad({0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}, 5);
    for (int k = 0; k < 20; ++k) {
      const double x = k / 20.0;
      const std::vector<Vec3> strip{
          {x, 0, 0.5}, {x + share / 20, 0, 0.5}, {x + share / 20, 1, 0.5}, {x, 1, 0.5}};
      if (share > 0) scene.patch(strip, scene.polygon(strip));
    }
    mesh = scene.take();
    tree = cluster_tree(mesh);
    set = occluder_set(mesh, tree);
    for (std::size_t k = 0; k < tree.clusters.size(); ++k) {
      const Cluster& cluster = tree.clusters[k];
      if (cluster.size() != 25) continue;
      if (!cluster.planar) continue;
      const int patch = tree.patches[cluster.begin].patch;
      if (patch < 25)
        a = static_cast<int>(k);
      else if (patch < 50)
        b = static_cast<int>(k);
    }
  }

  BlockSights sorted(double factor) const {
    const OccluderScene scene(set);
    return SightSorter(tree, scene, 1).sort(a, b, std::vector<double>(625, 1e-4), factor);
  }
};

int count(const BlockSights& found, Sight sight) {
  return static_cast<int>(std::count(found.sights.begin(), found.sights.end(), sight));
}

TEST(SortSights, CallsAllPairsOfPlatesBehindAClosedScreenHidden) {
  const Plates plates(1);
  ASSERT_GE(plates.a, 0);
  ASSERT_GE(plates.b, 0);

  const BlockSights found = plates.sorted(1e-3);

  EXPECT_EQ(count(found, Sight::none), 625);
}

TEST(SortSights, CallsPairsBehindManySlitsPartlyHidden) {
  const Plates plates(0.5);

  const BlockSights found = plates.sorted(1e-5);

  // every patch is four strips wide
  EXPECT_EQ(count(found, Sight::part), 625);
}

TEST(SortSights, LeavesAloneWhatItIsNotAskedFor) {
  const Plates plates(1);
  const OccluderScene scene(plates.set);
  std::vector<double> unhidden(625, 1e-4);
  unhidden[7] = 0;

  const BlockSights found = SightSorter(plates.tree, scene, 1).sort(plates.a, plates.b, unhidden, 1e-3);

  EXPECT_EQ(found.sights[7], Sight::unknown);
  EXPECT_EQ(count(found, Sight::none), 624);
}

// Every planar pair of clusters of at most 16 patches of a room with turned boxes against clipping.
TEST(SortSights, ErrsByAsMuchAsItIsAllowedAndWithoutBias) {
  const PatchMesh mesh = testing::room_with_turned_boxes(6, 3);
  const ClusterTree tree = cluster_tree(mesh);
  const OccluderSet set = occluder_set(mesh, tree);
  const OccluderScene scene(set);
  const SightSorter sorter(tree, scene, 1);
  FormFactorOptions options;
  options.accuracy = 1e-4;
  options.visibility = Visibility::exact;
  options.precision = Precision::float64;
  const ExchangeMatrix exact = form_factors(mesh, options).exchange_areas;
  const double factor = 1e-3;

  std::vector<double> row_error(static_cast<std::size_t>(mesh.size()));
  double sum = 0;
  int decided = 0;
  for (std::size_t a = 0; a < tree.clusters.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const Cluster &ca = tree.clusters[a], &cb = tree.clusters[b];
      // clusters of 9 to 16 patches: each pair of patches in one block
      const auto fits = [](const Cluster& c) { return c.planar && c.size() > 8 && c.size() <= 16; };
      if (!fits(ca) || !fits(cb) || !may_face(ca, cb)) continue;
      std::vector<double> unhidden;
      for (int s = ca.begin; s < ca.end; ++s) {
        for (int t = cb.begin; t < cb.end; ++t) {
          const Polygon &p = tree.patches[s].outline, &q = tree.patches[t].outline;
          unhidden.push_back(exchange_area(std::span(p.corners.data(), static_cast<std::size_t>(p.count)),
                                           std::span(q.corners.data(), static_cast<std::size_t>(q.count))));
        }
      }
      const BlockSights found = sorter.sort(static_cast<int>(a), static_cast<int>(b), unhidden, factor);
      std::size_t k = 0;
      for (int s = ca.begin; s < ca.end; ++s) {
        for (int t = cb.begin; t < cb.end; ++t, ++k) {
          if (found.sights[k] != Sight::whole && found.sights[k] != Sight::none) continue;
          ++decided;
          const WorkPatch &p = tree.patches[s], &q = tree.patches[t];
          const double seen = exact(p.patch, q.patch) * tree.scale * tree.scale;
          const double error = (found.sights[k] == Sight::whole ? unhidden[k] : 0) - seen;
          row_error[static_cast<std::size_t>(p.patch)] += error / p.area;
          row_error[static_cast<std::size_t>(q.patch)] += error / q.area;
          sum += error;
        }
      }
    }
  }
  double squares = 0;
  for (double error : row_error) squares += error * error / static_cast<double>(mesh.size());

  EXPECT_GT(decided, 10'000);
  EXPECT_LT(std::sqrt(squares), factor);
  // errors of both signs: of the total area 6 units less than a tenth of the rows' error
  EXPECT_LT(std::abs(sum) / (6 * tree.scale * tree.scale), 0.2 * factor);
}

}  // namespace
}  // namespace luxel
