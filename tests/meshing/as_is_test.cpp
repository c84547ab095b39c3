#include <gtest/gtest.h>

#include "luxel/input_error.h"
#include "luxel/mesh_scene.h"
#include "meshing/scenes.h"

namespace luxel {
namespace {

const MeshingOptions as_is = {.as_is = true};

TEST(AsIs, GivesOnePatchPerFaceInFileOrder) {
  const Scene scene = SceneMaker().room({0, 0, 0}, {1, 2, 3}).scene();

  const PatchMesh mesh = mesh_scene(scene, as_is);

  ASSERT_EQ(mesh.size(), 6);
  EXPECT_EQ(mesh.vertices.size(), 8u);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(mesh.faces[i], i);
  EXPECT_TRUE(mesh.normals[0].isApprox(Vec3(0, 0, 1)));
  EXPECT_DOUBLE_EQ(total_area(mesh), 22);
  EXPECT_TRUE(mesh.centroids[0].isApprox(Vec3(0.5, 1, 0)));
}

TEST(AsIs, SplitsConcaveFacesIntoConsecutivePieces) {
  SceneMaker maker;
  maker.face({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  maker.face({{0, 0, 1}, {2, 0, 1}, {2, 1, 1}, {1, 1, 1}, {1, 2, 1}, {0, 2, 1}});  // an L of area 3
  maker.face({{0, 0, 2}, {1, 0, 2}, {0, 1, 2}});

  const PatchMesh mesh = mesh_scene(maker.scene(), as_is);

  EXPECT_EQ(mesh.faces, (std::vector<int>{0, 1, 1, 1, 1, 2}));
  EXPECT_EQ(mesh.report.split_faces, 1);
  EXPECT_DOUBLE_EQ(total_area(mesh), 4);
  for (int i = 0; i < mesh.size(); ++i) EXPECT_TRUE(mesh.normals[i].isApprox(Vec3(0, 0, 1)));
}

TEST(AsIs, SplitsQuadsThatAreNotFlat) {
  const Scene bent = SceneMaker().face({{0, 0, 0}, {1, 0, 0}, {1, 1, 1e-5}, {0, 1, 0}}).scene();
  const Scene flat = SceneMaker().face({{0, 0, 0}, {1, 0, 0}, {1, 1, 1e-6}, {0, 1, 0}}).scene();

  EXPECT_EQ(mesh_scene(bent, as_is).size(), 2);
  EXPECT_EQ(mesh_scene(flat, as_is).size(), 1);
}

TEST(AsIs, GivesTwoSidedFacesFrontThenBack) {
  SceneMaker maker;
  const int sheet = maker.add_finish({.two_sided = true});
  maker.face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, sheet);

  const PatchMesh mesh = mesh_scene(maker.scene(), as_is);

  ASSERT_EQ(mesh.size(), 2);
  EXPECT_TRUE(mesh.normals[0].isApprox(Vec3(0, 0, 1)));
  EXPECT_TRUE(mesh.normals[1].isApprox(Vec3(0, 0, -1)));
  EXPECT_EQ(mesh.faces, (std::vector<int>{0, 0}));
  EXPECT_EQ(mesh.polygons[0], mesh.polygons[1]);
}

TEST(AsIs, LeavesOutFacesWithoutAreaAndKeepsTheirNumber) {
  SceneMaker maker;
  maker.face({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  maker.face({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});

  const PatchMesh mesh = mesh_scene(maker.scene(), as_is);

  EXPECT_EQ(mesh.faces, std::vector<int>{1});
  EXPECT_EQ(mesh.report.degenerate_faces, 1);
  ASSERT_EQ(mesh.warnings.size(), 1u);
  EXPECT_NE(mesh.warnings[0].find("first: face 0"), std::string::npos);
}

TEST(AsIs, MergesRepeatedFacesOfTheSameSideOnly) {
  SceneMaker maker;
  maker.face({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  maker.face({{1, 0, 0}, {0, 1, 0}, {0, 0, 0}});  // same side, other first corner
  maker.face({{0, 0, 0}, {0, 1, 0}, {1, 0, 0}});  // opposite side

  const PatchMesh mesh = mesh_scene(maker.scene(), as_is);

  EXPECT_EQ(mesh.faces, (std::vector<int>{0, 2}));
  EXPECT_EQ(mesh.report.duplicate_faces, 1);
  EXPECT_EQ(mesh.occluders.triangles.size(), 1u);
  EXPECT_EQ(mesh.polygons[0], mesh.polygons[1]);
}

TEST(AsIs, KeepsItsDigitsFarFromTheOriginAndAtAnyScale) {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    for (const double shift : {0.0, 1e8}) {
      const Vec3 low = Vec3::Constant(shift * scale);
      const Vec3 high = low + scale * Vec3(1, 2, 3);
      const Scene scene = SceneMaker().room(low, high).scene();

      const PatchMesh mesh = mesh_scene(scene, as_is);

      // An edge is known to the rounding of its ends: 1e8 * 2^-53 = 1.1e-8 of the unit each, four per area.
      const double tolerance = shift > 0 ? 1e-7 : 1e-14;
      EXPECT_EQ(mesh.vertices.size(), 8u);
      EXPECT_NEAR(total_area(mesh) / (scale * scale * 22), 1, tolerance);
    }
  }
}

TEST(AsIs, KeepsATinyBodyInALargeScene) {
  SceneMaker maker;
  maker.room({0, 0, 0}, {1, 1, 1});
  maker.block({0.5, 0.5, 0.5}, {0.500001, 0.500001, 0.500001});

  const PatchMesh mesh = mesh_scene(maker.scene(), as_is);

  EXPECT_EQ(mesh.size(), 12);
  EXPECT_EQ(mesh.vertices.size(), 16u);
}

TEST(AsIs, RefusesASceneWithoutArea) {
  const Scene scene = SceneMaker().face({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}).scene();

  EXPECT_THROW(mesh_scene(scene, as_is), InputError);
  EXPECT_THROW(mesh_scene(Scene{}, as_is), InputError);
}

}  // namespace
}  // namespace luxel
