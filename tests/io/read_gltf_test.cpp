#include <Eigen/Geometry>
#include <array>
#include <cstring>
#include <numbers>

#include "io/scene_files.h"

namespace luxel {
namespace {

using testing::finish_of;
using testing::group_of;
using testing::material_of;
using testing::SceneFiles;

// Three corners of the unit square as floats, then two triangles of them as 16-bit indices; 48 bytes.
std::string square_buffer() {
  const std::array<float, 12> points{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  const std::array<std::uint16_t, 6> indices{0, 1, 2, 0, 2, 3};
  std::string buffer(sizeof points + sizeof indices, '\0');
  std::memcpy(buffer.data(), points.data(), sizeof points);
  std::memcpy(buffer.data() + sizeof points, indices.data(), sizeof indices);
  return buffer;
}

std::string gltf(const std::string& nodes, const std::string& buffer_uri, const std::string& more = "") {
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": )" + nodes + R"(,
    "meshes": [{"name": "square", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
    "materials": [{"name": "lamp", "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0.125, 1], "metallicFactor": 0},
                   "emissiveFactor": [1, 0.5, 0], "doubleSided": true,
                   "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 16}}}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0,0,0], "max": [1,1,0]},
                  {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
    "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
    "buffers": [{"byteLength": 60)" +
         buffer_uri + "}]" + more + "}";
}

Vec3 normal_of(const Scene& scene, int face) {
  const std::vector<int> c = testing::corners_of(scene, face);
  return (scene.vertices[c[1]] - scene.vertices[c[0]]).cross(scene.vertices[c[2]] - scene.vertices[c[0]]);
}

TEST(ReadGltf, ReadsMaterialsWithTheirEmissiveStrength) {
  SceneFiles files;
  files.with("a.bin", square_buffer());
  files.with("a.gltf", gltf(R"([{"mesh": 0}])", R"(, "uri": "a.bin")"));

  const Scene scene = files.read("a.gltf");

  ASSERT_EQ(scene.face_count(), 2);
  EXPECT_EQ(group_of(scene, 0), "square");
  EXPECT_EQ(material_of(scene, 0), "lamp");
  EXPECT_TRUE((finish_of(scene, 0).reflectance == Rgb(0.5, 0.25, 0.125)).all());
  EXPECT_TRUE((finish_of(scene, 0).emission == std::numbers::pi * Rgb(16, 8, 0)).all());
  EXPECT_TRUE(finish_of(scene, 0).two_sided);
  EXPECT_TRUE((finish_of(files.read("a.gltf", {EmissionUnit::Exitance}), 0).emission == Rgb(16, 8, 0)).all());
}

TEST(ReadGltf, AppliesTheTransformsOfNestedNodes) {
  SceneFiles files;
  files.with("a.bin", square_buffer());
  files.with("a.gltf", gltf(R"([{"children": [1], "translation": [10, 0, 0]},
                               {"mesh": 0, "name": "panel", "scale": [2, 3, 1], "rotation": [0, 0, 1, 0]}])",
                            R"(, "uri": "a.bin")"));

  const Scene scene = files.read("a.gltf");

  EXPECT_EQ(group_of(scene, 0), "panel");
  // Half a turn about z, exact but for the rounding of the quaternion's products.
  EXPECT_LT((scene.vertices[2] - Vec3(8, -3, 0)).norm(), 1e-14);
}

TEST(ReadGltf, KeepsTheFrontOfAMirroredNode) {
  SceneFiles files;
  files.with("a.bin", square_buffer());
  files.with("a.gltf", gltf(R"([{"mesh": 0, "matrix": [-1,0,0,0, 0,1,0,0, 0,0,1,0, 5,0,0,1]}])",
                            R"(, "uri": "a.bin")"));

  const Scene scene = files.read("a.gltf");

  EXPECT_EQ(scene.vertices[1], Vec3(4, 0, 0));
  EXPECT_EQ(normal_of(scene, 0), Vec3(0, 0, 1));
}

TEST(ReadGltf, ReadsTheBinaryContainer) {
  SceneFiles files;
  std::string json = gltf(R"([{"mesh": 0}])", "");
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string buffer = square_buffer();
  const auto word = [](std::uint32_t number) {
    std::string bytes(4, '\0');
    std::memcpy(bytes.data(), &number, 4);
    return bytes;
  };
  const auto length = static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + buffer.size());
  files.with("a.glb", "glTF" + word(2) + word(length) + word(static_cast<std::uint32_t>(json.size())) +
                          "JSON" + json + word(static_cast<std::uint32_t>(buffer.size())) +
                          std::string("BIN\0", 4) + buffer);

  EXPECT_EQ(files.read("a.glb").face_count(), 2);
}

TEST(ReadGltf, CountsWhatItDoesNotUse) {
  SceneFiles files;
  files.with("a.bin", square_buffer());
  files.with("a.gltf", gltf(R"([{"mesh": 0}])", R"(, "uri": "a.bin")",
                            R"(, "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 3}]}})"));

  EXPECT_EQ(files.read("a.gltf").warnings[0],
            (files / "a.gltf").string() + ": not used: KHR_lights_punctual (1 time)");
}

TEST(ReadGltf, RefusesWhatItCannotRead) {
  SceneFiles files;
  files.with("a.bin", square_buffer()).with("short.bin", square_buffer().substr(0, 50));
  const std::string good = gltf(R"([{"mesh": 0}])", R"(, "uri": "a.bin")");
  const auto with = [&](const std::string& found, const std::string& other) {
    std::string text = good;
    return text.replace(text.find(found), found.size(), other);
  };
  const auto refusal = [&](const std::string& text) {
    files.with("bad.gltf", text);
    return files.refusal_of("bad.gltf");
  };

  EXPECT_EQ(refusal(with(R"("count": 6)", R"("count": 7)")),
            "bad.gltf: accessor 1: reaches beyond its buffer");
  EXPECT_EQ(refusal(with(R"("count": 4)", R"("count": 3)")),
            "bad.gltf: accessor 1: index 3; expected less than 3");
  EXPECT_EQ(refusal(with("[0.5, 0.25", "[1.5, 0.25")),
            "bad.gltf: material \"lamp\": base colour out of range; expected 0 to 1");
  EXPECT_EQ(refusal(with("\"emissiveStrength\": 16", "\"emissiveStrength\": -1")),
            "bad.gltf: material \"lamp\": emission out of range; expected 0 to 1e100");
  EXPECT_EQ(refusal(with("\"mesh\": 0", "\"mesh\": 9")), "bad.gltf: names a mesh that does not exist");
  EXPECT_EQ(refusal(with("[{\"mesh\": 0}]", "[{\"children\": [0]}]")),
            "bad.gltf: nodes are nested deeper than 256, or in a circle");
  EXPECT_EQ(refusal(with("\"scene\": 0,",
                         "\"scene\": 0, \"extensionsRequired\": [\"KHR_draco_mesh_compression\"],")),
            "bad.gltf: needs the extension \"KHR_draco_mesh_compression\", which is not read");
  for (const std::string& text :
       {std::string("{"), std::string("[]"), std::string("glTF"), with("a.bin", "gone.bin")}) {
    const std::string message = refusal(text);
    EXPECT_TRUE(message.starts_with("bad.gltf: not glTF 2.0: ")) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace luxel
