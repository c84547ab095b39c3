#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "luxel/mesh_scene.h"
#include "meshing/scenes.h"

namespace luxel {
namespace {

const MeshingOptions as_is = {.as_is = true};
const MeshingOptions about_500 = {.patches = 500};

/// Of two materials, so that they are not merged.
Scene two_squares(double shift, const Finish& second = {}) {
  SceneMaker maker;
  const int other = maker.add_finish(second);
  maker.face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  maker.face({{shift, shift, 0}, {1 + shift, shift, 0}, {1 + shift, 1 + shift, 0}, {shift, 1 + shift, 0}},
             other);
  return maker.scene();
}

double area_of_face(const PatchMesh& mesh, int face) {
  double area = 0;
  for (int i = 0; i < mesh.size(); ++i) area += mesh.faces[i] == face ? mesh.areas[i] : 0;
  return area;
}

double patches_at(const PatchMesh& mesh, const Vec3& point, const Vec3& normal) {
  int count = 0;
  for (int i = 0; i < mesh.size(); ++i) {
    bool inside = mesh.normals[i].dot(normal) > 0.999;
    for (int k = 0; k < mesh.corner_count(i); ++k) {
      const Vec3& a = mesh.vertices[mesh.corners[i][k]];
      const Vec3& b = mesh.vertices[mesh.corners[i][(k + 1) % mesh.corner_count(i)]];
      inside = inside && (b - a).cross(point - a).dot(mesh.normals[i]) >= 0;
    }
    inside = inside && std::abs((point - mesh.centroids[i]).dot(normal)) < 1e-6;
    count += inside;
  }
  return count;
}

TEST(Overlap, TheLaterFaceLosesWhatTheEarlierCovers) {
  const PatchMesh mesh = mesh_scene(two_squares(0.4), about_500);

  EXPECT_NEAR(area_of_face(mesh, 0), 1, 1e-12);
  EXPECT_NEAR(area_of_face(mesh, 1), 1 - 0.36, 1e-12);
  EXPECT_NEAR(mesh.report.overlap_area, 0.36, 1e-12);
  EXPECT_EQ(mesh.report.overlapping_faces, 1);
  EXPECT_LT(mesh.report.area_error, 1e-12);
  EXPECT_EQ(mesh.report.remaining_t_vertices, 0);
  ASSERT_EQ(mesh.warnings.size(), 1u);
  EXPECT_NE(mesh.warnings[0].find("1 face lies"), std::string::npos) << mesh.warnings[0];
  EXPECT_NE(mesh.warnings[0].find("0.36 m2 (first: face 1 and face 0)"), std::string::npos);
  EXPECT_EQ(patches_at(mesh, {0.7123, 0.6177, 0}, {0, 0, 1}), 1);
}

TEST(Overlap, AsIsKeepsAllFacesAndWarns) {
  const PatchMesh mesh = mesh_scene(two_squares(0.4), as_is);

  EXPECT_EQ(mesh.size(), 2);
  EXPECT_DOUBLE_EQ(total_area(mesh), 2);
  EXPECT_NEAR(mesh.report.overlap_area, 0.36, 1e-12);
  EXPECT_LT(mesh.report.area_error, 1e-12);
  ASSERT_EQ(mesh.warnings.size(), 1u);
  EXPECT_NE(mesh.warnings[0].find("counts twice"), std::string::npos) << mesh.warnings[0];
}

TEST(Overlap, FacesKeptBecauseTheyAreFinerThanAskedAreCut) {
  SceneMaker maker;
  maker.room({0, 0, 0}, {3, 3, 3});
  maker.face({{1, 1, 0}, {4, 1, 0}, {4, 2, 0}, {1, 2, 0}});  // 2 of its 3 m2 lie on the floor

  const PatchMesh mesh = mesh_scene(maker.scene(), {.patches = 1});

  EXPECT_NEAR(area_of_face(mesh, 6), 1, 1e-12);
  EXPECT_NEAR(total_area(mesh), 55, 1e-12);
}

TEST(Overlap, OppositeSidesAreBothKept) {
  SceneMaker maker;
  maker.face({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
  maker.block({0.5, 0.5, 0}, {1, 1, 1});  // its base looks down into the floor

  const PatchMesh mesh = mesh_scene(maker.scene(), about_500);

  EXPECT_EQ(mesh.report.overlapping_faces, 0);
  EXPECT_NEAR(total_area(mesh), 4 + 2 * 0.25 + 4 * 0.5, 1e-12);
  EXPECT_TRUE(mesh.warnings.empty());
  EXPECT_EQ(mesh.occluders.coplanar.size(), 1u);
}

TEST(Overlap, ATwoSidedFaceKeepsTheSideThatIsFree) {
  const Finish sheet = {.two_sided = true};

  const PatchMesh mesh = mesh_scene(two_squares(0.4, sheet), about_500);

  EXPECT_NEAR(area_of_face(mesh, 1), 2 - 0.36, 1e-12);
  EXPECT_NEAR(mesh.report.overlap_area, 0.36, 1e-12);
  EXPECT_EQ(patches_at(mesh, {0.7123, 0.6177, 0}, {0, 0, 1}), 1);
  EXPECT_EQ(patches_at(mesh, {0.7123, 0.6177, 0}, {0, 0, -1}), 1);
}

TEST(Overlap, FacesThatOnlyTouchAreLeftAlone) {
  SceneMaker maker;
  for (int x = 0; x < 5; ++x) {
    for (int y = 0; y < 5; ++y) {
      // shifted row by row, so that no edge has a partner of the same length
      const Vec3 low(x + 0.3 * y, y, 0);
      maker.face({low, low + Vec3(1, 0, 0), low + Vec3(1, 1, 0), low + Vec3(0, 1, 0)});
    }
  }

  const PatchMesh mesh = mesh_scene(maker.scene(), about_500);

  EXPECT_EQ(mesh.report.overlapping_faces, 0);
  EXPECT_TRUE(mesh.warnings.empty());
  EXPECT_TRUE(mesh.occluders.coplanar.empty());
}

TEST(Overlap, SheetsAThousandthOfAMillimetreApartAreBothKept) {
  SceneMaker maker;
  maker.face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  maker.face({{0.4, 0.4, 1e-5}, {1.4, 0.4, 1e-5}, {1.4, 1.4, 1e-5}, {0.4, 1.4, 1e-5}});

  const PatchMesh mesh = mesh_scene(maker.scene(), about_500);

  EXPECT_EQ(mesh.report.overlapping_faces, 0);
  EXPECT_NEAR(total_area(mesh), 2, 1e-12);
}

TEST(Overlap, ATurnedTriangleLeavesTheUnionOfBoth) {
  SceneMaker maker;
  const int other = maker.add_finish({});
  maker.face({{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}});
  maker.face({{1, 1, 0}, {5, 1, 0}, {1, 4, 0}},
             other);  // half of 4 x 3; outside of the square lie two triangles

  const PatchMesh mesh = mesh_scene(maker.scene(), about_500);

  // x >= 3: legs 2 and 1.5; y >= 3: legs 4/3 and 1; both: nothing (the slanted side passes below (3, 3))
  EXPECT_NEAR(area_of_face(mesh, 1), 1.5 + 2.0 / 3, 1e-12);
  EXPECT_EQ(mesh.report.remaining_t_vertices, 0);
}

TEST(Overlap, AConcaveFaceIsCoveredByItsPartsAndCoversWithThem) {
  const std::vector<Vec3> letter_l = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  const std::vector<Vec3> square = {{0.5, 0.5, 0}, {2.5, 0.5, 0}, {2.5, 2.5, 0}, {0.5, 2.5, 0}};
  // the square has 0.5 x 1.5 + 1.5 x 0.5 - 0.5 x 0.5 of the L
  const double common = 1.25;

  SceneMaker l_first, square_first;
  l_first.face(letter_l).face(square, l_first.add_finish({}));
  square_first.face(square).face(letter_l, square_first.add_finish({}));

  const PatchMesh first = mesh_scene(l_first.scene(), about_500);
  const PatchMesh second = mesh_scene(square_first.scene(), about_500);

  EXPECT_NEAR(area_of_face(first, 1), 4 - common, 1e-12);
  EXPECT_NEAR(area_of_face(second, 1), 3 - common, 1e-12);
}

TEST(Overlap, TheSameSquareCutTwoWaysIsCountedOnce) {
  SceneMaker maker;
  maker.face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}).face({{0, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  maker.face({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}).face({{1, 0, 0}, {1, 1, 0}, {0, 1, 0}});

  const PatchMesh mesh = mesh_scene(maker.scene(), about_500);

  EXPECT_NEAR(total_area(mesh), 1, 1e-12);
  EXPECT_EQ(mesh.report.overlapping_faces, 2);
}

/// Four walls as boxes that overlap at the corners, each as high as the others, around 1.8 x 1.8.
Scene walls_of_boxes(double turn = 0) {
  SceneMaker maker;
  maker.block({0, 0, 0}, {2, 0.1, 1}).block({0, 1.9, 0}, {2, 2, 1});
  maker.block({0, 0, 0}, {0.1, 2, 1}).block({1.9, 0, 0}, {2, 2, 1});
  Scene scene = maker.scene();
  const Eigen::AngleAxisd rotation(turn, Vec3(0.3, 0.5, 0.8).normalized());
  for (Vec3& p : scene.vertices) p = rotation * p + turn * Vec3(10, 20, 5);
  return scene;
}

TEST(Overlap, WallsOfBoxesHaveTheAreaOfTheUnionOfTheirFaces) {
  for (const double turn : {0.0, 1.1}) {
    const PatchMesh mesh = mesh_scene(walls_of_boxes(turn), {.patches = 3000});

    // outsides 4 x 2; insides 4 x 2, with the 0.1 that run into the neighbours; the ends of two walls lie in
    // the outsides of the others: gone; tops and bottoms: the ring of 4 - 1.8 x 1.8 once each
    EXPECT_NEAR(total_area(mesh), 16 + 2 * (4 - 1.8 * 1.8), 1e-9) << turn;
    EXPECT_EQ(mesh.report.remaining_t_vertices, 0);
  }
}

}  // namespace
}  // namespace luxel
