#include "transport/hierarchical/patch_hierarchy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "solver/hierarchical_scenes.h"
#include "transport/hierarchical/active_tree.h"
#include "transport/hierarchical/node_interpolation.h"

namespace luxel {
namespace {

using namespace luxel::testing;

PatchMesh triangles() {
  return cut_faces(room_with_a_box(), 7, true);
}

TEST(PatchHierarchy, HoldsEveryPatchOnceUnderItsRoot) {
  for (const PatchMesh& mesh : {triangles(), inward_sphere(8)}) {
    const PatchHierarchy hierarchy = patch_hierarchy(mesh, enclosures_of(mesh));

    std::vector<int> sorted = hierarchy.order;
    std::sort(sorted.begin(), sorted.end());
    for (int p = 0; p < mesh.size(); ++p) EXPECT_EQ(sorted[p], p);
    for (int c = 0; c < hierarchy.cluster_count(); ++c) {
      const PatchCluster& cluster = hierarchy.clusters[c];
      int at = cluster.begin;
      for (int k = 0; k < cluster.child_count; ++k) {
        const int child = cluster.children[k];
        const bool single = hierarchy.single(child);
        EXPECT_EQ(single ? child - hierarchy.cluster_count() : hierarchy.clusters[child].begin, at);
        at = single ? at + 1 : hierarchy.clusters[child].end;
        if (single) continue;
        EXPECT_EQ(hierarchy.clusters[child].parent, c);
        EXPECT_GT(child, c);
      }
      EXPECT_EQ(at, cluster.end);
      EXPECT_GE(cluster.child_count, 2);
    }
    EXPECT_EQ(hierarchy.clusters[hierarchy.root].end - hierarchy.clusters[hierarchy.root].begin, mesh.size());
  }
}

TEST(PatchHierarchy, PutsNodesWhereTheyIntegrateLinearAndSquareFunctions) {
  const PatchMesh mesh = triangles();
  const PatchHierarchy hierarchy = patch_hierarchy(mesh, enclosures_of(mesh));

  for (const PatchCluster& cluster : hierarchy.clusters) {
    if (cluster.flat_group < 0) continue;
    const ClusterAxes& axes = cluster.axes;
    // exact over triangles: the mean of squares at the three edges' middles
    double area = 0, mean_s = 0, square_s = 0, square_t = 0;
    for (int k = cluster.begin; k < cluster.end; ++k) {
      const auto& corners = mesh.corners[hierarchy.order[k]];
      const double part = mesh.areas[hierarchy.order[k]] / 3;
      for (int e = 0; e < 3; ++e) {
        const Vec3 x = hierarchy.frame((mesh.vertices[corners[e]] + mesh.vertices[corners[(e + 1) % 3]]) / 2);
        const double s = axes.u.dot(x - axes.middle), t = axes.v.dot(x - axes.middle);
        area += part;
        mean_s += part * s;
        square_s += part * s * s;
        square_t += part * t * t;
      }
    }
    EXPECT_NEAR(mean_s / area, 0, 1e-13);
    EXPECT_NEAR(square_s / area, axes.spread_s * axes.spread_s, 1e-13);
    EXPECT_NEAR(square_t / area, axes.spread_t * axes.spread_t, 1e-13);
    EXPECT_NEAR(cluster.weights[0] + cluster.weights[1] + cluster.weights[2] + cluster.weights[3], 1, 1e-14);
  }
}

TEST(PatchHierarchy, KeepsFinishesAndEnclosuresApart) {
  PatchMesh mesh = triangles();
  mesh.finish_table.resize(2);
  for (int i = 0; i < mesh.size(); ++i) mesh.finishes[i] = mesh.centroids[i].x() > 0.4;
  const PatchHierarchy hierarchy = patch_hierarchy(mesh, enclosures_of(mesh));

  for (const PatchCluster& cluster : hierarchy.clusters) {
    if (cluster.flat_group < 0) continue;
    for (int k = cluster.begin; k < cluster.end; ++k) {
      EXPECT_EQ(mesh.finishes[hierarchy.order[k]], hierarchy.groups[cluster.flat_group].finish);
    }
  }
}

TEST(NodeInterpolation, IsAdjointAndLeavesConstantsAlone) {
  for (const PatchMesh& mesh : {triangles(), inward_sphere(8)}) {
    const PatchHierarchy hierarchy = patch_hierarchy(mesh, enclosures_of(mesh));
    const NodeInterpolation interpolation(hierarchy, active_tree(hierarchy, {}));
    const int patches = interpolation.patches(), nodes = interpolation.unknowns();
    std::mt19937 random(5);
    std::vector<double> x(patches), y(nodes), means(nodes), values(patches);
    for (double& v : x) v = random() / 4294967296.0;
    for (double& v : y) v = random() / 4294967296.0;

    interpolation.to_nodes(x.data(), means.data(), 1);
    interpolation.to_patches(y.data(), values.data(), 1);

    double on_nodes = 0, on_patches = 0;
    for (int i = 0; i < nodes; ++i) on_nodes += interpolation.node_areas()[i] * y[i] * means[i];
    for (int i = 0; i < patches; ++i) on_patches += interpolation.areas()[i] * x[i] * values[i];
    EXPECT_NEAR(on_nodes, on_patches, 1e-12 * on_patches);

    const std::vector<double> ones(std::max(patches, nodes), 1.0);
    interpolation.to_nodes(ones.data(), means.data(), 1);
    interpolation.to_patches(ones.data(), values.data(), 1);
    for (double v : means) EXPECT_NEAR(v, 1, 1e-13);
    for (double v : values) EXPECT_NEAR(v, 1, 1e-13);
  }
}

}  // namespace
}  // namespace luxel
