#include "vertices_on_edges.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <numeric>
#include <set>

namespace luxel {
namespace {

std::vector<int> all_of(const std::vector<Vec3>& vertices) {
  std::vector<int> all(vertices.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// A square lattice of unit edges in the plane z = 0: vertex x + n y at (x, y).
struct Lattice {
  explicit Lattice(int n) {
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) {
        vertices.emplace_back(x, y, 0);
        if (x > 0) edges.push_back({x - 1 + n * y, x + n * y});
        if (y > 0) edges.push_back({x + n * (y - 1), x + n * y});
      }
    }
  }
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 2>> edges;
};

TEST(VerticesOnEdges, AreNoneInALattice) {
  const Lattice lattice(40);

  EXPECT_TRUE(find_vertices_on_edges(lattice.vertices, all_of(lattice.vertices), lattice.edges).empty());
}

TEST(VerticesOnEdges, AreFoundOnShortEdgesAndOnThoseAcrossTheWholeLattice) {
  constexpr int n = 40;
  Lattice lattice(n);
  lattice.edges.push_back({0, n * n - 1});            // the diagonal: 38 vertices inside
  lattice.edges.push_back({n * (n - 1), n * n - 1});  // a side: as many
  lattice.edges.push_back({1, 2 + 2 * n});            // (1, 0) to (2, 2): none
  lattice.edges.push_back({0, 2 + 2 * n});            // (0, 0) to (2, 2): one
  const int first_long = static_cast<int>(lattice.edges.size()) - 4;

  const auto found = find_vertices_on_edges(lattice.vertices, all_of(lattice.vertices), lattice.edges);

  ASSERT_EQ(found.size(), 38u + 38u + 1u);
  for (int k = 0; k < 38; ++k) {
    EXPECT_EQ(found[k].edge, first_long);
    EXPECT_EQ(found[k].vertex, (k + 1) * (n + 1));
    EXPECT_NEAR(found[k].place, (k + 1.0) / (n - 1), 1e-12);
    EXPECT_EQ(found[38 + k].edge, first_long + 1);
    EXPECT_EQ(found[38 + k].vertex, n * (n - 1) + k + 1);
  }
  EXPECT_EQ(found.back().edge, first_long + 3);
  EXPECT_EQ(found.back().vertex, n + 1);
}

TEST(VerticesOnEdges, AreLookedForAmongTheCandidatesOnly) {
  const std::vector<Vec3> vertices = {{0, 0, 0}, {3, 0, 0}, {1, 0, 0}, {2, 0, 0}};

  const auto found = find_vertices_on_edges(vertices, std::vector<int>{0, 1, 3}, {{0, 1}});

  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].vertex, 3);
}

TEST(VerticesOnEdges, StandOnceHoweverCrowdedTheyAre) {
  // 1000 vertices within a thousandth of a long edge, half of them on it, and many short edges elsewhere: the
  // grid, made for those, is too fine for the long one and too coarse for the crowd.
  Lattice lattice(30);
  const int begin = static_cast<int>(lattice.vertices.size());
  lattice.vertices.emplace_back(0, 0, 5);
  lattice.vertices.emplace_back(29, 0, 5);
  for (int k = 0; k < 1000; ++k) lattice.vertices.emplace_back(14 + k * 1e-3, (k % 2) * 1e-3, 5);
  lattice.edges.push_back({begin, begin + 1});
  lattice.edges.push_back({begin + 2, begin + 6});  // over (14.002, 0)

  const auto found = find_vertices_on_edges(lattice.vertices, all_of(lattice.vertices), lattice.edges);

  std::set<std::pair<int, int>> pairs;
  for (const VertexOnEdge& on : found) pairs.emplace(on.edge, on.vertex);
  EXPECT_EQ(pairs.size(), found.size());
  EXPECT_EQ(found.size(), 500u + 1u);
  EXPECT_EQ(found.back().vertex, begin + 4);
}

TEST(VerticesOnEdges, AreTheSameForAnyNumberOfThreads) {
  Lattice lattice(120);
  for (int k = 0; k < 119; ++k) lattice.vertices.emplace_back(k + 0.25, 60, 0);
  const std::vector<int> candidates = all_of(lattice.vertices);

  const auto found_with = [&](int threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return find_vertices_on_edges(lattice.vertices, candidates, lattice.edges);
  };
  const auto alone = found_with(1);
  const auto together = found_with(2);

  ASSERT_EQ(alone.size(), 119u);
  ASSERT_EQ(together.size(), alone.size());
  for (std::size_t k = 0; k < alone.size(); ++k) {
    EXPECT_EQ(together[k].edge, alone[k].edge);
    EXPECT_EQ(together[k].vertex, alone[k].vertex);
    EXPECT_EQ(together[k].place, alone[k].place);
  }
}

}  // namespace
}  // namespace luxel
