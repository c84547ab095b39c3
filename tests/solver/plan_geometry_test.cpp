#include <gtest/gtest.h>

#include <numeric>

#include "solver/closed_meshes.h"
#include "solver/plan_scenes.h"

namespace luxel {
namespace {

using testing::Boxes;

Boxes cube() {
  return Boxes().add({0, 0, 0}, {1, 1, 1}, true);
}

/// The unit cube with its floor in four triangles, whose common corner is raised.
PatchMesh cube_with_raised_floor(double height) {
  Boxes boxes = cube();
  const auto floor = boxes.faces.front();
  boxes.faces.erase(boxes.faces.begin());
  const int middle = static_cast<int>(boxes.vertices.size());
  boxes.vertices.push_back({0.5, 0.5, height});
  for (int k = 0; k < 4; ++k) boxes.faces.push_back({floor[k], floor[(k + 1) % 4], middle, -1});
  return boxes.mesh();
}

TEST(ConvexInside, HoldsForABoxOfAnySizeAnywhere) {
  EXPECT_TRUE(convex_inside(cube().mesh()));
  EXPECT_TRUE(convex_inside(cube().moved(1e-6, Vec3::Zero()).mesh()));
  EXPECT_TRUE(convex_inside(cube().moved(1, {1e4, -1e4, 1e4}).mesh()));
}

TEST(ConvexInside, HoldsWhereAFaceIsSlightlyPushedOut) {
  EXPECT_TRUE(convex_inside(cube_with_raised_floor(-1e-3)));
}

TEST(ConvexInside, FailsWhereAFaceIsSlightlyPushedIn) {
  EXPECT_FALSE(convex_inside(cube_with_raised_floor(1e-3)));
  EXPECT_FALSE(convex_inside(cube_with_raised_floor(1e-6)));
  EXPECT_FALSE(convex_inside(cube_with_raised_floor(1e-8)));
}

TEST(ConvexInside, FailsWithAHoleABlockOrAnOutside) {
  Boxes open = cube();
  open.faces.pop_back();
  Boxes furnished = cube();
  furnished.add({0.4, 0.4, 0.4}, {0.6, 0.6, 0.6}, false);

  EXPECT_FALSE(convex_inside(open.mesh()));
  EXPECT_FALSE(convex_inside(furnished.mesh()));
  EXPECT_FALSE(convex_inside(Boxes().add({0, 0, 0}, {1, 1, 1}, false).mesh()));
  EXPECT_FALSE(convex_inside(PatchMesh()));
}

TEST(ConvexInside, FailsWhereOneFaceLooksOut) {
  Boxes boxes = cube();
  std::swap(boxes.faces[2][1], boxes.faces[2][3]);

  EXPECT_FALSE(convex_inside(boxes.mesh()));
}

TEST(PlannedEnclosures, AreWhatRaysWouldFindInABox) {
  const PatchMesh mesh = cube().mesh();

  const Enclosures planned = planned_enclosures(mesh);
  const Enclosures found = find_enclosures(mesh, RayScene(mesh.occluders));

  EXPECT_EQ(planned.closed, found.closed);
  EXPECT_EQ(planned.count, found.count);
  EXPECT_EQ(planned.enclosure, found.enclosure);
  EXPECT_EQ(planned.open_share, found.open_share);
  EXPECT_EQ(planned.rays, 0);
}

TEST(HidingPolygons, AreNoneInABoxAndThoseOfABlockInIt) {
  Boxes furnished = cube();
  furnished.add({0.4, 0.4, 0.4}, {0.6, 0.6, 0.6}, false);

  EXPECT_EQ(hiding_polygons(cube().mesh()), 0);
  EXPECT_EQ(hiding_polygons(furnished.mesh()), 6);
}

TEST(HidingPolygons, CountAFaceThatIsSlightlyConcave) {
  EXPECT_EQ(hiding_polygons(cube_with_raised_floor(-1e-8)), 0);
  // each of the four sees the others' far corners behind it
  EXPECT_EQ(hiding_polygons(cube_with_raised_floor(1e-8)), 4);
}

TEST(SubMesh, KeepsThePatchesAsTheyAre) {
  const PatchMesh all = testing::rooms_in_a_row(3, 2, Rgb::Constant(0.5));
  std::vector<int> second(24);
  std::iota(second.begin(), second.end(), 24);

  const PatchMesh part = sub_mesh(all, second, true);

  ASSERT_EQ(part.size(), 24);
  EXPECT_EQ(part.vertices.size(), 26u);  // a cube of 2 x 2 squares a side
  EXPECT_EQ(part.occluders.polygon_count, 6);
  EXPECT_EQ(part.occluders.triangles.size(), 12u);
  for (int i = 0; i < 24; ++i) {
    EXPECT_EQ(part.areas[i], all.areas[24 + i]);
    EXPECT_EQ(part.normals[i], all.normals[24 + i]);
    for (int k = 0; k < 4; ++k) {
      EXPECT_EQ(part.vertices[part.corners[i][k]], all.vertices[all.corners[24 + i][k]]);
    }
  }
}

TEST(SubMesh, OfAnOpenEnclosureKeepsWhatStandsBetween) {
  // two plates with a sheet of another enclosure between them
  testing::SceneBuilder scene;
  scene.quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, 1);
  scene.quad({0, 0, 2}, {0, 1, 2}, {1, 1, 2}, {1, 0, 2}, 1);
  scene.quad({0.2, 0.2, 1}, {0.8, 0.2, 1}, {0.8, 0.8, 1}, {0.2, 0.8, 1}, 1);
  scene.quad({9, 9, 9}, {10, 9, 9}, {10, 10, 9}, {9, 10, 9}, 1);
  const PatchMesh all = scene.take();

  const PatchMesh part = sub_mesh(all, {0, 1}, false);

  EXPECT_EQ(part.occluders.polygon_count, 3);
  EXPECT_EQ(hiding_polygons(part), 1);
}

TEST(SubMesh, RefusesPatchesThatAreNotThere) {
  EXPECT_THROW(sub_mesh(cube().mesh(), {6}, true), std::invalid_argument);
  EXPECT_THROW(sub_mesh(cube().mesh(), {-1}, true), std::invalid_argument);
}

}  // namespace
}  // namespace luxel
