#include <algorithm>
#include <numbers>

#include "io/scene_files.h"

namespace luxel {
namespace {

using testing::corners_of;
using testing::finish_of;
using testing::group_of;
using testing::material_of;
using testing::SceneFiles;
using testing::square_vertices;
using Corners = std::vector<int>;

const std::string square(square_vertices);

TEST(ReadObj, KeepsPolygonsAsTheyStand) {
  SceneFiles files;
  files.with("a.obj", square + "v 2 0.5 0\nf 1 2 3\nf 1 2 3 4\nf 1 2 5 3 4\n");

  const Scene scene = files.read("a.obj");

  ASSERT_EQ(scene.face_count(), 3);
  EXPECT_EQ(corners_of(scene, 0), (Corners{0, 1, 2}));
  EXPECT_EQ(corners_of(scene, 1), (Corners{0, 1, 2, 3}));
  EXPECT_EQ(corners_of(scene, 2), (Corners{0, 1, 4, 2, 3}));
  EXPECT_EQ(scene.vertices[4], Vec3(2, 0.5, 0));
}

TEST(ReadObj, CountsNegativeIndicesBackFromTheLastVertex) {
  SceneFiles files;
  files.with("a.obj", square + "f -4 -3 -2 -1\nv 5 5 5\nf -5 -4 -1\n");

  const Scene scene = files.read("a.obj");

  EXPECT_EQ(corners_of(scene, 0), (Corners{0, 1, 2, 3}));
  EXPECT_EQ(corners_of(scene, 1), (Corners{0, 1, 4}));
}

TEST(ReadObj, ReadsEveryFormOfCorner) {
  SceneFiles files;
  files.with("a.obj", square + "f 1/1 2/2 3/3\nf 1//2 3//4 4//6\nf 1/7/2 2/7/2 4/7/2\nf -4/-1/-1 2 3//\n");

  const Scene scene = files.read("a.obj");

  EXPECT_EQ(corners_of(scene, 0), (Corners{0, 1, 2}));
  EXPECT_EQ(corners_of(scene, 1), (Corners{0, 2, 3}));
  EXPECT_EQ(corners_of(scene, 2), (Corners{0, 1, 3}));
  EXPECT_EQ(corners_of(scene, 3), (Corners{0, 1, 2}));
}

TEST(ReadObj, AllowsFacesBeforeTheirVertices) {
  SceneFiles files;
  files.with("a.obj", "f 1 2 3 4\n" + square);

  EXPECT_EQ(corners_of(files.read("a.obj"), 0), (Corners{0, 1, 2, 3}));
}

TEST(ReadObj, TakesTheGroupElseTheObjectElseDefault) {
  SceneFiles files;
  files.with("a.obj", square + "f 1 2 3\no house\nf 1 2 3\ng roof\nf 1 2 3\ng\nf 1 2 3\n");

  const Scene scene = files.read("a.obj");

  EXPECT_EQ(group_of(scene, 0), "default");
  EXPECT_EQ(group_of(scene, 1), "house");
  EXPECT_EQ(group_of(scene, 2), "roof");
  EXPECT_EQ(group_of(scene, 3), "house");
}

TEST(ReadObj, NumbersNamesInOrderOfFirstUseByAFace) {
  SceneFiles files;
  files.with("a.obj", square + "g unused\ng b\nusemtl y\nf 1 2 3\ng a\nusemtl x\nf 1 2 3\ng b\nf 1 2 3\n");

  const Scene scene = files.read("a.obj");

  EXPECT_EQ(scene.groups, (std::vector<std::string>{"b", "a"}));
  EXPECT_EQ(scene.materials, (std::vector<std::string>{"y", "x"}));
  EXPECT_EQ(scene.face_groups, (std::vector<int>{0, 1, 0}));
}

TEST(ReadObj, KeepsTheMaterialNameThatNoLibraryDefines) {
  SceneFiles files;
  files.with("a.obj", square + "f 1 2 3\nusemtl dark oak\nf 1 2 3\nf 1 3 4\n");

  const Scene scene = files.read("a.obj");

  EXPECT_EQ(material_of(scene, 0), "default");
  EXPECT_EQ(material_of(scene, 1), "dark oak");
  EXPECT_TRUE((finish_of(scene, 1).reflectance == 0.5).all());
  EXPECT_TRUE((finish_of(scene, 1).emission == 0).all());
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_EQ(scene.warnings[0],
            "3 faces of material \"default\", \"dark oak\" described nowhere: reflectance 0.5, no emission");
}

TEST(ReadObj, ReadsTheLineEndsTabsMarksAndContinuationsOfOtherPrograms) {
  SceneFiles files;
  files.with("dos.obj", "\xEF\xBB\xBFv 0 0 0\r\nv\t1\t0\t0 \r\nv 1 1 0\r\ng a # b\r\nf 1 \\\r\n 2 3\r\n");
  files.with("mac.obj", "v 0 0 0\rv 1 0 0\rv 1 1 0\rf 1 2 3\r");
  files.with("open_end.obj", "v +0 0 0\nv 1. 0 0\nv 1E0 1 .0\nf 1 2 3");

  EXPECT_EQ(corners_of(files.read("dos.obj"), 0), (Corners{0, 1, 2}));
  EXPECT_EQ(files.read("dos.obj").groups[0], "a");
  EXPECT_EQ(corners_of(files.read("mac.obj"), 0), (Corners{0, 1, 2}));
  EXPECT_EQ(files.read("open_end.obj").vertices[2], Vec3(1, 1, 0));
}

TEST(ReadObj, TellsTheLineWhereAContinuedStatementBegins) {
  SceneFiles files;
  files.with("a.obj", square + "f 1 \\\n 2 \\\n x\n");

  EXPECT_EQ(files.refusal_of("a.obj"), "a.obj:5: face corner \"x\"; expected a vertex number");
}

TEST(ReadObj, KeepsCoordinatesToTheLastBit) {
  SceneFiles files;
  files.with("a.obj", "v 100000000 0 0\nv 100000001 0.1 0\nv 0 1e-300 1e-400\nf 1 2 3\n");

  const Scene scene = files.read("a.obj");

  EXPECT_EQ(scene.vertices[1] - scene.vertices[0], Vec3(1, 0.1, 0));
  EXPECT_EQ(scene.vertices[2], Vec3(0, 1e-300, 0));
}

TEST(ReadObj, CountsWhatItDoesNotUse) {
  SceneFiles files;
  files.with("a.obj", "v 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0\nvn 0 0 1\nvn 0 0 1\nl 1 2\nf 1 2 3\nblub 7\n");

  const Scene scene = files.read("a.obj");

  EXPECT_EQ(scene.warnings[0],
            (files / "a.obj").string() +
                ": not used: colour of v (1 time), vn (2 times), l (1 time), blub (1 time)");
}

TEST(ReadMtl, TakesKdAsReflectanceAndKeAsRadiance) {
  SceneFiles files;
  files.with("a.mtl", "newmtl lamp # warm\n Kd 0.78 0.5 0.25 # sand\n\tKe 17 12 4\n");
  files.with("a.obj", "mtllib a.mtl\n" + square + "usemtl lamp\nf 1 2 3 4\n");

  const Finish radiance = finish_of(files.read("a.obj"), 0);
  const Finish exitance = finish_of(files.read("a.obj", {.emission_unit = EmissionUnit::Exitance}), 0);

  EXPECT_TRUE((radiance.reflectance == Rgb(0.78, 0.5, 0.25)).all());
  EXPECT_TRUE((radiance.emission == std::numbers::pi * Rgb(17, 12, 4)).all());
  EXPECT_TRUE((exitance.emission == Rgb(17, 12, 4)).all());
  EXPECT_TRUE(files.read("a.obj").warnings.empty());
}

TEST(ReadMtl, TakesOneNumberForThree) {
  SceneFiles files;
  files.with("a.mtl", "newmtl grey\nKd 0.3\n");
  files.with("a.obj", "mtllib a.mtl\n" + square + "usemtl grey\nf 1 2 3 4\n");

  EXPECT_TRUE((finish_of(files.read("a.obj"), 0).reflectance == 0.3).all());
}

TEST(ReadMtl, WarnsOnceOfEachKindOfStatementThatIsNotUsed) {
  SceneFiles files;
  files.with("a.mtl",
             "newmtl a\nKd 1 1 1\nmap_Kd -s 1 1 1 a b.png\nKs 0 0 0\nd 1\nTr 0\n"
             "newmtl b\nKd 0 0 0\nmap_Kd b.png\nKs 0.1 0 0\nd 0.5\n");
  files.with("a.obj", "mtllib a.mtl\n" + square + "usemtl a\nf 1 2 3 4\n");

  const Scene scene = files.read("a.obj");

  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_EQ(scene.warnings[0],
            (files / "a.mtl").string() + ": not used: map_Kd (2 times), Ks (1 time), d (1 time)");
}

TEST(ReadMtl, WarnsOfALibraryThatDoesNotExist) {
  SceneFiles files;
  files.with("a.obj", "mtllib gone.mtl\n" + square + "usemtl a\nf 1 2 3 4\n");

  const Scene scene = files.read("a.obj");

  ASSERT_EQ(scene.warnings.size(), 2u);
  EXPECT_EQ(scene.warnings[0],
            (files / "a.obj").string() + ":1: material library \"gone.mtl\" does not exist");
  EXPECT_EQ(scene.warnings[1], "1 face of material \"a\" described nowhere: reflectance 0.5, no emission");
}

TEST(ReadMtl, ReadsSeveralLibrariesAndNamesWithBlanks) {
  SceneFiles files;
  files.with("my walls.mtl", "newmtl red brick\nKd 0.6 0.2 0.1\n")
      .with("b.mtl", "newmtl b\nKd 0.1 0.1 0.1\n");
  files.with("c.mtl", "newmtl c\nKd 0.2 0.2 0.2\nnewmtl b\nKd 1 1 1\n");
  files.with("a.obj", "mtllib my walls.mtl\nmtllib b.mtl c.mtl\n" + square +
                          "usemtl red brick\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl c\nf 1 2 3\n");

  const Scene scene = files.read("a.obj");

  EXPECT_TRUE((finish_of(scene, 0).reflectance == Rgb(0.6, 0.2, 0.1)).all());
  EXPECT_TRUE((finish_of(scene, 1).reflectance == 0.1).all()) << "the first definition counts";
  EXPECT_TRUE((finish_of(scene, 2).reflectance == 0.2).all());
  EXPECT_EQ(scene.warnings[0],
            (files / "c.mtl").string() + ":3: material \"b\" is defined a second time; the first one counts");
}

TEST(ReadMtl, WarnsOfAMaterialWithoutReflectance) {
  SceneFiles files;
  files.with("a.mtl", "newmtl lamp\nKe 1 1 1\n");
  files.with("a.obj", "mtllib a.mtl\n" + square + "usemtl lamp\nf 1 2 3 4\n");

  const Scene scene = files.read("a.obj");

  EXPECT_TRUE((finish_of(scene, 0).reflectance == 0.5).all());
  EXPECT_EQ(scene.warnings[0], "1 face of material \"lamp\" without a stated reflectance: 0.5");
}

TEST(ReadScene, KnowsItsExtensionsInCapitalsToo) {
  SceneFiles files;
  files.with("A.OBJ", square + "f 1 2 3 4\n");

  EXPECT_EQ(files.read("A.OBJ").face_count(), 1);
  const std::vector<std::string> known = scene_extensions();
  EXPECT_NE(std::find(known.begin(), known.end(), ".obj"), known.end());
}

}  // namespace
}  // namespace luxel
