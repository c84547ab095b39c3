#include <Eigen/Geometry>
#include <numbers>

#include "io/scene_files.h"

namespace luxel {
namespace {

using testing::finish_of;
using testing::group_of;

Scene example(const std::string& name) {
  return read_scene(std::filesystem::path(LUXEL_TEST_DATA) / "../../examples/scenes" / name);
}

// Sum of the vector areas of a group's faces: points where its front looks.
Vec3 vector_area(const Scene& scene, const std::string& group) {
  Vec3 sum = Vec3::Zero();
  for (int f = 0; f < scene.face_count(); ++f) {
    if (group_of(scene, f) != group) continue;
    const std::vector<int> corners = testing::corners_of(scene, f);
    for (std::size_t c = 0; c < corners.size(); ++c) {
      sum += 0.5 * scene.vertices[corners[c]].cross(scene.vertices[corners[(c + 1) % corners.size()]]);
    }
  }
  return sum;
}

// Products of lengths near 1 m in double; a few tens of roundings of 1e-16.
constexpr double rounding = 1e-14;

TEST(ExampleScenes, CornellHasThePublishedLengthsAndFronts) {
  const Scene scene = example("cornell/cornell.json");

  // Areas from the published corners, in m2; y up, light and ceiling look down, blocks look out.
  EXPECT_LT((vector_area(scene, "floor") - Vec3(0, 0.5 * (0.5528 + 0.5496) * 0.5592, 0)).norm(), rounding);
  EXPECT_LT((vector_area(scene, "light") - Vec3(0, -0.130 * 0.105, 0)).norm(), rounding);
  EXPECT_LT((vector_area(scene, "ceiling") - Vec3(0, -(0.556 * 0.5592 - 0.130 * 0.105), 0)).norm(), rounding);
  EXPECT_LT((vector_area(scene, "back_wall") - Vec3(0, 0, -0.5 * (0.5496 + 0.556) * 0.5488)).norm(),
            rounding);
  EXPECT_LT((vector_area(scene, "right_wall") - Vec3(0.5488 * 0.5592, 0, 0)).norm(), rounding);
  EXPECT_LT(vector_area(scene, "left_wall").x(), -0.3);
  // A block is closed but for its bottom, so its vector area is the bottom's, turned up: the top's, as both
  // are equal.
  EXPECT_GT(vector_area(scene, "short_block").y(), 0.02);
  EXPECT_LT((vector_area(scene, "short_block").cwiseProduct(Vec3(1, 0, 1))).norm(), rounding);
  EXPECT_LT((vector_area(scene, "tall_block").cwiseProduct(Vec3(1, 0, 1))).norm(), rounding);
  EXPECT_EQ(scene.groups.size(), 8u);
}

TEST(ExampleScenes, CornellIsLitByItsLightAlone) {
  const Scene scene = example("cornell/cornell.json");

  for (int f = 0; f < scene.face_count(); ++f) {
    const Rgb expected =
        group_of(scene, f) == "light" ? Rgb(std::numbers::pi * Rgb(17, 12, 4)) : Rgb(Rgb::Zero());
    EXPECT_TRUE((finish_of(scene, f).emission == expected).all()) << group_of(scene, f);
  }
  EXPECT_TRUE(scene.warnings.empty());
  ASSERT_TRUE(scene.camera);
  EXPECT_EQ(scene.camera->eye, 0.001 * Vec3(278, 273, -800));
}

// The vector area of a closed surface is zero.
TEST(ExampleScenes, RoomsAreClosed) {
  for (const char* name : {"furnished_room.json", "two_rooms.json"}) {
    const Scene scene = example(name);

    Vec3 sum = Vec3::Zero();
    for (const std::string& group : scene.groups) sum += vector_area(scene, group);

    // About a hundred products of lengths up to 8 m.
    EXPECT_LT(sum.norm(), 1e-12) << name;
    EXPECT_TRUE(scene.warnings.empty()) << name << ": " << scene.warnings.front();
  }
}

TEST(ExampleScenes, FurnishedRoomSpreadsThePowerOfItsLamp) {
  const Scene scene = example("furnished_room.json");

  for (int f = 0; f < scene.face_count(); ++f) {
    if (group_of(scene, f) != "lamp") continue;
    // 12 W from 0.6 x 0.6 m2; the sides carry a rounding of 1e-16 each.
    EXPECT_NEAR(finish_of(scene, f).emission[0], 12 / 0.36, 1e-12);
  }
}

TEST(ExampleScenes, TwoRoomsMirrorOneAnother) {
  const Scene scene = example("two_rooms.json");

  // Two floors of 16 m2 and a doorway of 0.15 x 0.9 m2 look up; the walls' vector areas cancel across the
  // mirror.
  EXPECT_LT((vector_area(scene, "floor") - Vec3(0, 0, 32.135)).norm(), 1e-12);
  EXPECT_LT(std::abs(vector_area(scene, "walls").x()), 1e-12);
}

}  // namespace
}  // namespace luxel
