#include "split_mesh.h"

#include <gtest/gtest.h>

#include "half_edge_mesh.h"
#include "index_mesh.h"

namespace luxel {
namespace {

TEST(SplitMesh, HoldsManifoldPartsOnHalfEdgesAndOthersByIndex) {
  // a tetrahedron; three triangles on the edge 4 - 5
  const auto meshes =
      make_split_meshes({{0, 2, 1}, {0, 1, 3}, {4, 5, 6}, {1, 2, 3}, {5, 4, 7}, {2, 0, 3}, {4, 5, 8}},
                        {0, 1, 2, 3, 4, 5, 6}, 9);

  ASSERT_EQ(meshes.size(), 2u);
  EXPECT_NE(dynamic_cast<const HalfEdgeMesh*>(meshes[0].get()), nullptr);
  EXPECT_EQ(meshes[0]->tags(), (std::vector<int>{0, 1, 3, 5}));
  EXPECT_EQ(meshes[0]->edge_count(), 6);
  EXPECT_NE(dynamic_cast<const IndexMesh*>(meshes[1].get()), nullptr);
  EXPECT_EQ(meshes[1]->tags(), (std::vector<int>{2, 4, 6}));
  EXPECT_EQ(meshes[1]->edge_count(), 7);
}

TEST(SplitMesh, TakesTrianglesThatRunTheSameWayForNonManifold) {
  const auto meshes = make_split_meshes({{0, 1, 2}, {0, 1, 3}}, {0, 1}, 4);

  ASSERT_EQ(meshes.size(), 1u);
  EXPECT_NE(dynamic_cast<const IndexMesh*>(meshes[0].get()), nullptr);
}

TEST(SplitMesh, LetsTwoFansMeetInAPointWithoutAWord) {
  // two tetrahedra tip to tip, and a strip of three triangles whose ends meet in the vertex 7 only
  const std::vector<std::array<int, 3>> triangles = {{0, 2, 1}, {0, 1, 3},  {1, 2, 3},   {2, 0, 3},
                                                     {3, 5, 4}, {3, 4, 6},  {4, 5, 6},   {5, 3, 6},
                                                     {7, 8, 9}, {8, 10, 9}, {10, 8, 11}, {10, 11, 7}};
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();

  const auto meshes = make_split_meshes(triangles, std::vector<int>(triangles.size(), 0), 12);

  EXPECT_EQ(testing::internal::GetCapturedStderr() + testing::internal::GetCapturedStdout(), "");
  ASSERT_EQ(meshes.size(), 1u);
  EXPECT_EQ(meshes[0]->triangles().size(), triangles.size());
  for (const auto& [a, b, c] : meshes[0]->triangles()) {
    EXPECT_TRUE(a < 12 && b < 12 && c < 12);
  }
}

TEST(SplitMesh, PassesTheTagOnToTheHalf) {
  for (const bool manifold : {true, false}) {
    std::vector<std::array<int, 3>> triangles = {{0, 1, 2}, {1, 0, 3}};
    if (!manifold) triangles.push_back({0, 1, 4});
    const auto meshes = make_split_meshes(triangles, {5, 6, 7}, 5);
    SplitMesh& mesh = *meshes[0];
    int edge = 0;
    while (mesh.ends(edge) != std::array{0, 1} && mesh.ends(edge) != std::array{1, 0}) ++edge;

    const std::span<const int> around = mesh.split(edge, 9);

    // both halves of the edge and one more edge in each triangle
    EXPECT_EQ(around.size(), 2 + triangles.size());
    for (std::size_t t = 0; t < mesh.triangles().size(); ++t) {
      const auto triangle = mesh.triangles()[t];
      const int apex = *std::find_if(triangle.begin(), triangle.end(), [](int v) { return v > 1 && v < 9; });
      EXPECT_EQ(mesh.tags()[t], apex + 3);
    }
  }
}

}  // namespace
}  // namespace luxel
