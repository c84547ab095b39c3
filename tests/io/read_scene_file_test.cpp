#include <Eigen/Geometry>
#include <numbers>

#include "io/scene_files.h"

namespace luxel {
namespace {

using testing::corners_of;
using testing::finish_of;
using testing::group_of;
using testing::SceneFiles;

// Two squares of 1 m2 and one of 4 m2: groups a and b of material white, group c of material lamp.
constexpr std::string_view three_squares =
    "mtllib three.mtl\n"
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
    "v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "v 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2\n"
    "g a\nusemtl white\nf 1 2 3 4\ng b\nf 5 6 7 8\ng c\nusemtl lamp\nf 9 10 11 12\n";
constexpr std::string_view three_materials =
    "newmtl white\nKd 0.7 0.7 0.7\nnewmtl lamp\nKd 0.1 0.1 0.1\nKe 1 2 3\n";

class ReadSceneFile : public ::testing::Test {
 protected:
  ReadSceneFile() { files_.with("three.obj", three_squares).with("three.mtl", three_materials); }

  Scene read(const std::string& members) {
    files_.with("s.json", R"({"mesh": "three.obj", )" + members + "}");
    return files_.read("s.json");
  }

  SceneFiles files_;
};

::testing::AssertionResult is(const Rgb& found, const Rgb& expected) {
  if ((found == expected).all()) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << found.transpose() << ", expected " << expected.transpose();
}

TEST_F(ReadSceneFile, AllowsComments) {
  const Scene scene = read("// a lamp\n \"unit\": /* of length */ \"m\"");

  EXPECT_EQ(scene.face_count(), 3);
  EXPECT_EQ(scene.file, (files_ / "s.json").string());
}

TEST_F(ReadSceneFile, ReadsEmissionInThreeWays) {
  const Scene scene =
      read(R"("surfaces": {"a": {"exitance": 2}, "b": {"radiance": [1, 2, 3]}, "c": {"power": 8}})");

  EXPECT_TRUE(is(finish_of(scene, 0).emission, {2, 2, 2}));
  EXPECT_TRUE(is(finish_of(scene, 1).emission, std::numbers::pi * Rgb(1, 2, 3)));
  EXPECT_TRUE(is(finish_of(scene, 2).emission, {2, 2, 2})) << "8 W from 4 m2";
}

TEST_F(ReadSceneFile, SpreadsPowerOverAllFacesOfTheSurface) {
  const Scene scene = read(R"("materials": {"white": {"power": [1, 2, 4]}})");

  EXPECT_TRUE(is(finish_of(scene, 0).emission, {0.5, 1, 2}));
  EXPECT_TRUE(is(finish_of(scene, 1).emission, {0.5, 1, 2}));
}

TEST_F(ReadSceneFile, SpreadsPowerOverBothSidesOfATwoSidedSurface) {
  const Scene scene = read(R"("materials": {"white": {"power": 3}}, "surfaces": {"a": {"two_sided": true}})");

  EXPECT_TRUE(is(finish_of(scene, 0).emission, {1, 1, 1})) << "two sides of a and one of b";
  EXPECT_TRUE(is(finish_of(scene, 1).emission, {1, 1, 1}));
}

TEST_F(ReadSceneFile, SpreadsPowerOverTheFacesThatTakeIt) {
  const Scene scene = read(R"("materials": {"white": {"power": 3}}, "surfaces": {"a": {"exitance": 7}})");

  EXPECT_TRUE(is(finish_of(scene, 0).emission, {7, 7, 7}));
  EXPECT_TRUE(is(finish_of(scene, 1).emission, {3, 3, 3}));
}

TEST_F(ReadSceneFile, SpreadsPowerInSquareMetresWhateverTheUnit) {
  const Scene scene = read(R"("unit": "cm", "surfaces": {"c": {"power": 8}})");

  // 4 cm2 = 4e-4 m2; three roundings, of the unit and of two products.
  EXPECT_NEAR(finish_of(scene, 2).emission[0], 20000, 20000 * 1e-15);
}

TEST_F(ReadSceneFile, CountsAFaceThatStandsTwiceAsOneArea) {
  files_.with("twice.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\ng a\nf 1 2 3 4\nf 3 4 1 5\n");
  files_.with("s.json", R"({"mesh": "twice.obj", "surfaces": {"a": {"power": 6}}})");

  EXPECT_TRUE(is(finish_of(files_.read("s.json"), 0).emission, {6, 6, 6}));
}

TEST_F(ReadSceneFile, WinsOverTheMaterialLibraryKeyByKey) {
  const Scene scene = read(R"("materials": {"lamp": {"reflectance": 0.2}})");

  EXPECT_TRUE(is(finish_of(scene, 2).reflectance, {0.2, 0.2, 0.2}));
  EXPECT_TRUE(is(finish_of(scene, 2).emission, std::numbers::pi * Rgb(1, 2, 3))) << "Ke stays";
}

TEST_F(ReadSceneFile, ReplacesKeByAnyEmissionOfItsOwn) {
  EXPECT_TRUE(is(finish_of(read(R"("materials": {"lamp": {"exitance": 1}})"), 2).emission, {1, 1, 1}));
  EXPECT_TRUE(is(finish_of(read(R"("surfaces": {"c": {"power": 4}})"), 2).emission, {1, 1, 1}));
  EXPECT_TRUE(is(finish_of(read(R"("surfaces": {"c": {"radiance": 0}})"), 2).emission, {0, 0, 0}));
}

TEST_F(ReadSceneFile, LetsSurfacesWinOverMaterialsKeyByKey) {
  const Scene scene = read(R"("materials": {"white": {"reflectance": 0.9, "exitance": 5, "two_sided": true}},
                              "surfaces": {"a": {"reflectance": [0.1, 0.2, 0.3]}, "b": {"two_sided": false}})");

  EXPECT_TRUE(is(finish_of(scene, 0).reflectance, {0.1, 0.2, 0.3}));
  EXPECT_TRUE(is(finish_of(scene, 0).emission, {5, 5, 5}));
  EXPECT_TRUE(finish_of(scene, 0).two_sided);
  EXPECT_TRUE(is(finish_of(scene, 1).reflectance, {0.9, 0.9, 0.9}));
  EXPECT_FALSE(finish_of(scene, 1).two_sided);
}

TEST_F(ReadSceneFile, KeepsEqualFinishesOnce) {
  const Scene scene = read(R"("surfaces": {"c": {"reflectance": 0.7, "exitance": 0}})");

  EXPECT_EQ(scene.finishes.size(), 1u);
}

TEST_F(ReadSceneFile, ReadsLengthsInTheUnit) {
  const Scene mm = read(R"("unit": "mm", "camera": {"eye": [0, 0, 5000], "target": [1000, 0, 0]})");
  const Scene inch = read(R"("unit": "in")");
  const Scene number = read(R"("unit": 2.5)");

  EXPECT_EQ(mm.vertices[2], 0.001 * Vec3(1, 1, 0));
  EXPECT_EQ(mm.camera->eye, Vec3(0, 0, 5));
  EXPECT_EQ(mm.camera->target, Vec3(1, 0, 0));
  EXPECT_EQ(inch.vertices[2], 0.0254 * Vec3(1, 1, 0));
  EXPECT_EQ(number.vertices[2], 2.5 * Vec3(1, 1, 0));
}

TEST_F(ReadSceneFile, ReadsTheCamera) {
  const Scene scene = read(R"("camera": {"eye": [1, 2, 3], "target": [4, 5, 6], "up": [0, 0, 1], "fov": 35.5,
                              "width": 320, "height": 200})");

  ASSERT_TRUE(scene.camera);
  EXPECT_EQ(scene.camera->eye, Vec3(1, 2, 3));
  EXPECT_EQ(scene.camera->target, Vec3(4, 5, 6));
  EXPECT_EQ(scene.camera->up, Vec3(0, 0, 1));
  EXPECT_EQ(scene.camera->fov, 35.5);
  EXPECT_EQ(scene.camera->width, 320);
  EXPECT_EQ(scene.camera->height, 200);
  EXPECT_FALSE(read(R"("unit": "m")").camera);
}

TEST_F(ReadSceneFile, PlacesSeveralMeshes) {
  files_.with("s.json", R"({"mesh": ["three.obj",
      {"mesh": "three.obj", "transform": [[1, 0, 0, 10], [0, 1, 0, 20], [0, 0, 1, 30], [0, 0, 0, 1]]},
      {"mesh": "three.obj", "transform": [0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}], "unit": "cm"})");

  const Scene scene = files_.read("s.json");

  EXPECT_EQ(scene.face_count(), 9);
  EXPECT_EQ(scene.groups, (std::vector<std::string>{"a", "b", "c"})) << "one name is one group";
  EXPECT_EQ(scene.vertices[12 + 2], 0.01 * Vec3(11, 21, 30)) << "moved in the unit";
  EXPECT_EQ(scene.vertices[24 + 1], 0.01 * Vec3(0, 1, 0)) << "x turned to y";
  EXPECT_EQ(corners_of(scene, 3), (std::vector<int>{12, 13, 14, 15}));
}

TEST_F(ReadSceneFile, KeepsTheFrontOfAMirroredMesh) {
  files_.with("s.json",
              R"({"mesh": [{"mesh": "three.obj", "transform": [-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}]})");

  const Scene scene = files_.read("s.json");

  const Vec3 a = scene.vertices[scene.face_vertices[0]], b = scene.vertices[scene.face_vertices[1]],
             c = scene.vertices[scene.face_vertices[2]];
  EXPECT_EQ((b - a).cross(c - b), Vec3(0, 0, 1)) << "the squares look up, and a mirror of x keeps up up";
}

TEST_F(ReadSceneFile, ReadsMeshesRelativeToItselfOrAbsolute) {
  std::filesystem::create_directory(files_ / "sub");
  files_.with("sub/up.json", R"({"mesh": "../three.obj"})");
  files_.with("sub/absolute.json", R"({"mesh": ")" + (files_ / "three.obj").string() + "\"}");

  EXPECT_EQ(files_.read("sub/up.json").face_count(), 3);
  EXPECT_EQ(files_.read("sub/absolute.json").face_count(), 3);
}

TEST_F(ReadSceneFile, AllowsAnEmptyListOfLights) {
  EXPECT_EQ(read(R"("lights": [])").face_count(), 3);
}

TEST_F(ReadSceneFile, WarnsOfPowerThatNoFaceTakes) {
  const Scene scene = read(R"("materials": {"lamp": {"power": 5}}, "surfaces": {"c": {"exitance": 1}})");

  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_EQ(scene.warnings[0], (files_ / "s.json").string() + ":1: power of \"lamp\" leaves from no face");
}

}  // namespace
}  // namespace luxel
