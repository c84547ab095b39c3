#include "longest_edge.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "half_edge_mesh.h"
#include "index_mesh.h"

namespace luxel {
namespace {

using Triangles = std::vector<std::array<int, 3>>;

std::vector<std::unique_ptr<SplitMesh>> only(std::unique_ptr<SplitMesh> mesh) {
  std::vector<std::unique_ptr<SplitMesh>> meshes;
  meshes.push_back(std::move(mesh));
  return meshes;
}

std::vector<int> numbers(int count) {
  std::vector<int> list(count);
  for (int i = 0; i < count; ++i) list[i] = i;
  return list;
}

/// Corners from the smallest on, and the tag; ascending.
std::vector<std::array<int, 4>> sorted(const LongestEdgeRefiner& refiner) {
  std::vector<std::array<int, 4>> rows;
  const Triangles triangles = refiner.triangles();
  const std::vector<int> tags = refiner.tags();
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    auto triangle = triangles[t];
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
    rows.push_back({triangle[0], triangle[1], triangle[2], tags[t]});
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

/// A bumpy sheet of n x n squares, each cut into two triangles, with a hole in its middle.
std::pair<std::vector<Vec3>, Triangles> bumpy_sheet(int n) {
  std::vector<Vec3> vertices;
  Triangles triangles;
  for (int y = 0; y <= n; ++y) {
    for (int x = 0; x <= n; ++x) vertices.emplace_back(x, 1.3 * y, std::sin(x * 1.7) * std::cos(y * 0.9));
  }
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      const int corner = y * (n + 1) + x;
      if (x == n / 2 && y == n / 2) continue;
      triangles.push_back({corner, corner + 1, corner + n + 2});
      triangles.push_back({corner, corner + n + 2, corner + n + 1});
    }
  }
  return {vertices, triangles};
}

TEST(LongestEdge, HalvesUntilNoEdgeIsLonger) {
  std::vector<Vec3> vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  LongestEdgeRefiner refiner(vertices, make_split_meshes({{0, 1, 2}, {0, 2, 3}}, {7, 8}, 4), {});

  refiner.refine(0.1);

  double area = 0;
  for (const auto& [a, b, c] : refiner.triangles()) {
    EXPECT_LE((vertices[a] - vertices[b]).norm(), 0.1);
    EXPECT_LE((vertices[b] - vertices[c]).norm(), 0.1);
    EXPECT_LE((vertices[c] - vertices[a]).norm(), 0.1);
    area += (vertices[b] - vertices[a]).cross(vertices[c] - vertices[a]).z() / 2;
  }
  EXPECT_NEAR(area, 1, 1e-12);
  // Right isosceles triangles stay such: their longest edge goes 2^(1/2), 1, 2^(-1/2) .. 2^(-7/2) = 0.088 <
  // 0.1, eight halvings of each.
  EXPECT_EQ(refiner.triangles().size(), 512u);
  EXPECT_EQ(refiner.count(refiner.halvings(0.1)), 512u);
  EXPECT_EQ(refiner.count(refiner.halvings(1.1)), 4u);
  EXPECT_EQ(refiner.count(refiner.halvings(2)), 2u);
}

TEST(LongestEdge, KeepsThreeSheetsOnOneEdgeTogether) {
  std::vector<Vec3> vertices = {{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, -1, 0}, {1, 0, 1}};
  LongestEdgeRefiner refiner(vertices, make_split_meshes({{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}, {0, 1, 2}, 5),
                             {{0, 1}});

  refiner.refine(1.5);

  EXPECT_EQ(refiner.triangles().size(), 6u);
  EXPECT_EQ(vertices.size(), 6u);  // one middle for all three
  EXPECT_EQ(refiner.points_between(1, 0), std::vector<int>{5});
  EXPECT_FALSE(refiner.points_between(0, 2));
}

TEST(LongestEdge, GivesTheSameTrianglesOnHalfEdgesAndByIndex) {
  const auto [vertices, triangles] = bumpy_sheet(9);
  const std::vector<int> tags = numbers(static_cast<int>(triangles.size()));
  const int vertex_count = static_cast<int>(vertices.size());
  std::vector<Vec3> on_half_edges = vertices;
  std::vector<Vec3> by_index = vertices;
  LongestEdgeRefiner half_edges(
      on_half_edges, only(std::make_unique<HalfEdgeMesh>(triangles, numbers(vertex_count), tags)), {});
  LongestEdgeRefiner index(by_index, only(std::make_unique<IndexMesh>(triangles, tags, vertex_count)), {});

  half_edges.refine(0.2);
  index.refine(0.2);

  EXPECT_GT(on_half_edges.size(), 10 * vertices.size());
  EXPECT_EQ(on_half_edges, by_index);
  EXPECT_EQ(sorted(half_edges), sorted(index));
}

}  // namespace
}  // namespace luxel
