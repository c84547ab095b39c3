// PLY, STL and OFF; glTF has a file of its own.
#include <array>
#include <bit>
#include <cstring>

#include "io/scene_files.h"

namespace luxel {
namespace {

using testing::corners_of;
using testing::finish_of;
using testing::SceneFiles;
using Corners = std::vector<int>;

// The bytes of numbers in the given order.
template <typename... Numbers>
std::string bytes(std::endian order, Numbers... numbers) {
  std::string all;
  const auto add = [&](auto number) {
    std::array<char, sizeof number> raw;
    std::memcpy(raw.data(), &number, raw.size());
    all += order == std::endian::native ? std::string(raw.begin(), raw.end())
                                        : std::string(raw.rbegin(), raw.rend());
  };
  (add(numbers), ...);
  return all;
}

TEST(ReadPly, KeepsReflectanceAndEmissionOfFaces) {
  SceneFiles files;
  files.with(
      "a.ply",
      "ply\nformat ascii 1.0\ncomment two faces\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nelement face 2\nproperty list uchar int vertex_indices\nproperty float reflectance\n"
      "property float emission_r\nproperty float emission_g\nproperty float emission_b\nend_header\n"
      "0 0 0\n1 0 0\n\n1 1 0\n0 1 0\n4 0 1 2 3 0.25 1 2 3\n3 0 1 2 0.5 0 0 0\n");

  const Scene scene = files.read("a.ply");

  EXPECT_EQ(corners_of(scene, 0), (Corners{0, 1, 2, 3}));
  EXPECT_EQ(corners_of(scene, 1), (Corners{0, 1, 2}));
  EXPECT_TRUE((finish_of(scene, 0).reflectance == 0.25).all());
  EXPECT_TRUE((finish_of(scene, 0).emission == Rgb(1, 2, 3)).all()) << "exitance as it stands";
  EXPECT_EQ(scene.vertices[2], Vec3(1, 1, 0));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(ReadPly, ReadsBothByteOrders) {
  SceneFiles files;
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    const std::string name = order == std::endian::little ? "binary_little_endian" : "binary_big_endian";
    files.with(name + ".ply", "ply\r\nformat " + name +
                                  " 1.0\r\nelement vertex 3\r\nproperty double x\r\nproperty float y\r\n"
                                  "property short z\r\nelement face 1\r\nproperty uchar red\r\n"
                                  "property list uchar uint vertex_index\r\nend_header\r\n" +
                                  bytes(order, 0.1, 0.5f, std::int16_t{-2}) +
                                  bytes(order, 1.0, 0.0f, std::int16_t{0}) +
                                  bytes(order, 0.0, 1.0f, std::int16_t{300}) +
                                  bytes(order, std::uint8_t{255}, std::uint8_t{3}, 2u, 0u, 1u));

    const Scene scene = files.read(name + ".ply");

    EXPECT_EQ(scene.vertices[0], Vec3(0.1, 0.5, -2));
    EXPECT_EQ(scene.vertices[2], Vec3(0, 1, 300));
    EXPECT_EQ(corners_of(scene, 0), (Corners{2, 0, 1}));
    EXPECT_EQ(scene.warnings[0], (files / (name + ".ply")).string() + ": not used: red of face (1 time)");
  }
}

TEST(ReadStl, ReadsTextWithItsNameAsGroup) {
  SceneFiles files;
  files.with(
      "a.stl",
      "solid bowl\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1e0 0 0\n   vertex 0 1 0\n"
      "  endloop\n endfacet\nendsolid bowl\n");

  const Scene scene = files.read("a.stl");

  EXPECT_EQ(scene.groups, (std::vector<std::string>{"bowl"}));
  EXPECT_EQ(scene.vertices[1], Vec3(1, 0, 0));
  EXPECT_EQ(corners_of(scene, 0), (Corners{0, 1, 2}));
}

TEST(ReadStl, ReadsBinaryEvenWhereItBeginsLikeText) {
  SceneFiles files;
  const auto triangle = bytes(std::endian::little, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 2.f, 0.f, 0.f, 0.f, 3.f, 0.f,
                              std::uint16_t{0});
  files.with("a.stl", "solid" + std::string(75, ' ') + bytes(std::endian::little, 2u) + triangle + triangle);

  const Scene scene = files.read("a.stl");

  EXPECT_EQ(scene.face_count(), 2);
  EXPECT_EQ(scene.vertices[5], Vec3(0, 3, 0));
}

TEST(ReadOff, TakesTheColourOfAFaceAsReflectance) {
  SceneFiles files;
  files.with("a.off",
             "OFF # comment\n4 3 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 0.1 0.2 0.3\n3 0 1 2 255 0 51 "
             "255\n3 0 1 2\n");

  const Scene scene = files.read("a.off");

  EXPECT_EQ(corners_of(scene, 0), (Corners{0, 1, 2, 3}));
  EXPECT_TRUE((finish_of(scene, 0).reflectance == Rgb(0.1, 0.2, 0.3)).all());
  EXPECT_TRUE((finish_of(scene, 1).reflectance == Rgb(1, 0, 0.2)).all());
  EXPECT_TRUE((finish_of(scene, 2).reflectance == 0.5).all());
  EXPECT_EQ(scene.warnings[0],
            "1 face of material \"default\" described nowhere: reflectance 0.5, no emission");
}

TEST(ReadFormats, LetTheSceneFileWin) {
  SceneFiles files;
  files.with("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 0.1 0.2 0.3\n");
  files.with("a.json", R"({"mesh": "a.off", "materials": {"default": {"reflectance": 0.9, "power": 1}}})");

  EXPECT_TRUE((finish_of(files.read("a.json"), 0).reflectance == 0.9).all());
  EXPECT_TRUE((finish_of(files.read("a.json"), 0).emission == 2).all()) << "1 W from 0.5 m2";
}

struct BadFile {
  const char* file;
  std::string text;
  std::string message;
};

TEST(ReadFormats, RefuseWhatTheyCannotRead) {
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nproperty float reflectance\nend_header\n";
  const std::string binary =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\nend_header\n";
  const std::vector<BadFile> bad_files{
      {"a.ply", "plx\n", "a.ply:1: expected \"ply\""},
      {"a.ply", "ply\nformat ascii 1.0\n", "a.ply:3: the file ends within the header; expected end_header"},
      {"a.ply", "ply\nformat ascii 1.0\nelement vertex -3\n",
       "a.ply:3: element \"vertex\" with count \"-3\"; expected a whole number"},
      {"a.ply", ply + "0 0 0\n1 0 0\n0 nan 0\n", "a.ply:13: found \"nan\"; expected a finite number"},
      {"a.ply", ply + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3 0.5\n",
       "a.ply:14: face 0: a corner is no vertex; expected 0 to 2"},
      {"a.ply", ply + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 1.5\n",
       "a.ply:14: face 0: reflectance out of range; expected 0 to 1"},
      {"a.ply", ply + "0 0 0\n1 0 0\n", "a.ply:12: the file ends; expected more elements"},
      {"a.ply", binary + "abcd", "a.ply: the file is cut off; expected more elements"},
      {"a.ply", binary + std::string(36, '\0'), "a.ply: has no faces"},
      {"a.stl", "solid a\nfacet\nouter loop\nvertex 0 0 inf\n",
       "a.stl:4: vertex coordinate \"inf\"; expected a finite number"},
      {"a.stl", "solid a\nfacet\nouter loop\nvertex 0 0 0\nendloop\n",
       "a.stl:5: facet with 1 corner; expected 3"},
      {"a.stl", "solid a\nendsolid a\n", "a.stl: has no faces"},
      {"a.stl", "no stl", "a.stl: is cut off, or no STL: 6 bytes for 0 triangles"},
      {"a.off", "OF\n", "a.off:1: found \"OF\"; expected OFF, COFF, NOFF or CNOFF"},
      {"a.off", "OFF\n3 x 0\n", "a.off:2: found \"x\"; expected the number of faces"},
      {"a.off", "OFF\n3 1 0\n0 0 0\n1 0\n", "a.off:4: vertex coordinate \"\"; expected a finite number"},
      {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n",
       "a.off:6: face corner \"3\"; expected a vertex from 0 to 2"},
      {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 0.5 -1 0\n",
       "a.off:6: colour of a face beyond its range; expected 0 to 1, or 0 to 255"},
      {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n", "a.off:5: the file ends; expected a face"},
  };
  SceneFiles files;
  for (const BadFile& bad : bad_files) {
    files.with(bad.file, bad.text);

    EXPECT_EQ(files.refusal_of(bad.file), bad.message);
  }
}

}  // namespace
}  // namespace luxel
