#include "form_factors/cluster_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

#include "solver/closed_meshes.h"

namespace luxel {
namespace {

using testing::box;
using testing::moved;
using testing::odd_rotation;
using testing::patch_mesh;

PatchMesh random_triangles(int count, double size) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  auto point = [&] { return Vec3(unit(random), unit(random), unit(random)); };
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 4>> corners;
  for (int t = 0; t < count; ++t) {
    const Vec3 centre = point();
    for (int k = 0; k < 3; ++k) vertices.push_back(centre + size * point());
    corners.push_back({3 * t, 3 * t + 1, 3 * t + 2, -1});
  }
  return patch_mesh(vertices, corners);
}

// A box blown up to a ball, seen from inside.
PatchMesh ball(int k) {
  PatchMesh mesh = box(k, true);
  for (Vec3& x : mesh.vertices) x = (x - Vec3::Constant(0.5)).normalized();
  return patch_mesh(mesh.vertices, mesh.corners);
}

std::vector<int> planar_roots(const ClusterTree& tree) {
  std::vector<int> roots, open{tree.root};
  while (!open.empty()) {
    const int id = open.back();
    open.pop_back();
    const Cluster& cluster = tree.clusters[id];
    if (cluster.planar) {
      roots.push_back(id);
    } else {
      open.push_back(cluster.left);
      open.push_back(cluster.right);
    }
  }
  return roots;
}

TEST(ClusterTree, HoldsEachPatchOnceInContiguousRanges) {
  for (const PatchMesh& mesh : {box(5, false), ball(4), random_triangles(100, 0.1)}) {
    const ClusterTree tree = cluster_tree(mesh);

    std::set<int> seen;
    for (const WorkPatch& patch : tree.patches) seen.insert(patch.patch);
    EXPECT_EQ(static_cast<int>(seen.size()), mesh.size());
    EXPECT_EQ(tree.clusters[tree.root].size(), mesh.size());
    for (const Cluster& cluster : tree.clusters) {
      if (cluster.leaf()) {
        EXPECT_EQ(cluster.size(), 1);
        continue;
      }
      EXPECT_EQ(tree.clusters[cluster.left].begin, cluster.begin);
      EXPECT_EQ(tree.clusters[cluster.left].end, tree.clusters[cluster.right].begin);
      EXPECT_EQ(tree.clusters[cluster.right].end, cluster.end);
    }
  }
}

TEST(ClusterTree, BoundsItsPatches) {
  for (const PatchMesh& mesh : {moved(box(5, false), odd_rotation(), 3, Vec3(5, 6, 7)), ball(4)}) {
    const ClusterTree tree = cluster_tree(mesh);

    for (const Cluster& cluster : tree.clusters) {
      for (int k = cluster.begin; k < cluster.end; ++k) {
        const WorkPatch& patch = tree.patches[k];
        EXPECT_LE(patch.edge, cluster.edge);
        for (int c = 0; c < patch.outline.count; ++c) {
          // rounding of coordinates up to 1
          EXPECT_LE((patch.outline[c] - cluster.centre).norm(), cluster.radius + 1e-15);
          if (cluster.planar) {
            EXPECT_LE(std::abs(cluster.plane.distance(patch.outline[c])), 1e-14);
          }
        }
      }
    }
  }
}

TEST(ClusterTree, WorksInCoordinatesOfSizeOneWithoutRounding) {
  const PatchMesh mesh = moved(box(4, false), Eigen::Matrix3d::Identity(), 1024, Vec3(1 << 20, 0, 0));

  const ClusterTree tree = cluster_tree(mesh);

  for (const WorkPatch& patch : tree.patches) {
    for (int c = 0; c < patch.outline.count; ++c) {
      const Vec3 back = patch.outline[c] / tree.scale + tree.centre;
      EXPECT_EQ(back, mesh.vertices[mesh.corners[patch.patch][c]]);
      EXPECT_LE(patch.outline[c].norm(), 1);
    }
  }
}

TEST(ClusterTree, FindsThePlanesOfARotatedBox) {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    const ClusterTree tree = cluster_tree(moved(box(6, true), odd_rotation(), scale, Vec3(scale, 0, -scale)));

    EXPECT_EQ(planar_roots(tree).size(), 6u) << scale;
  }
}

// Offsets cost digits: at 1e7 sizes away the corners are good to 1e-9.
TEST(ClusterTree, FindsThePlanesFarFromTheOrigin) {
  const ClusterTree tree = cluster_tree(moved(box(6, false), odd_rotation(), 1, Vec3(1e6, -1e6, 1e6)));

  EXPECT_EQ(planar_roots(tree).size(), 6u);
}

TEST(ClusterTree, TellsParallelPlanesApart) {
  for (const double gap : {1e-3, 1e-6}) {
    const std::vector<Vec3> vertices{{0, 0, 0},   {1, 0, 0},   {1, 1, 0},   {0, 1, 0},
                                     {0, 0, gap}, {1, 0, gap}, {1, 1, gap}, {0, 1, gap}};

    const ClusterTree tree = cluster_tree(patch_mesh(vertices, {{0, 1, 2, 3}, {4, 5, 6, 7}}));

    EXPECT_FALSE(tree.clusters[tree.root].planar) << gap;
  }
}

TEST(ClusterTree, TellsTheSidesOfASheetApart) {
  const ClusterTree tree =
      cluster_tree(patch_mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2, 3}, {3, 2, 1, 0}}));

  EXPECT_FALSE(tree.clusters[tree.root].planar);
}

TEST(ClusterTree, SplitsIntoWholeVectors) {
  const ClusterTree tree = cluster_tree(box(16, false));

  for (const Cluster& cluster : tree.clusters) {
    if (cluster.size() > 16) {
      EXPECT_EQ(tree.clusters[cluster.left].size() % 8, 0);
    }
  }
}

bool patches_face(const WorkPatch& a, const WorkPatch& b) {
  return span_along(a.outline, b.plane).high > 1e-11 && span_along(b.outline, a.plane).high > 1e-11;
}

TEST(MayFace, NeverDropsAVisiblePair) {
  for (const PatchMesh& mesh : {box(3, false), moved(box(3, true), odd_rotation(), 1, Vec3::Zero()), ball(3),
                                random_triangles(60, 0.1), random_triangles(60, 1.0)}) {
    const ClusterTree tree = cluster_tree(mesh);

    for (std::size_t i = 0; i < tree.clusters.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const Cluster &a = tree.clusters[i], &b = tree.clusters[j];
        if (may_face(a, b)) continue;
        for (int p = a.begin; p < a.end; ++p) {
          for (int q = b.begin; q < b.end; ++q) {
            EXPECT_FALSE(patches_face(tree.patches[p], tree.patches[q]));
          }
        }
      }
    }
  }
}

TEST(MayFace, DropsCoplanarAndBackFacingBlocks) {
  const std::vector<Vec3> vertices{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                   {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  // a floor that faces up and a ceiling that faces up
  const ClusterTree tree = cluster_tree(patch_mesh(vertices, {{0, 1, 2, 3}, {4, 5, 6, 7}}));

  const Cluster& root = tree.clusters[tree.root];
  EXPECT_FALSE(may_face(tree.clusters[root.left], tree.clusters[root.right]));
}

TEST(HeightsOver, BoundTheHeightsOfPoints) {
  for (const PatchMesh& mesh : {box(3, false), ball(3), random_triangles(40, 0.3)}) {
    const ClusterTree tree = cluster_tree(mesh);

    for (const Cluster& a : tree.clusters) {
      for (const Cluster& b : tree.clusters) {
        const Span bounds = heights_over(a, b);
        for (int p = a.begin; p < a.end; ++p) {
          for (int q = b.begin; q < b.end; ++q) {
            const Span heights = span_along(tree.patches[q].outline, tree.patches[p].plane);
            // rounding of coordinates up to 1
            EXPECT_GE(heights.low, bounds.low - 1e-14);
            EXPECT_LE(heights.high, bounds.high + 1e-14);
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace luxel
