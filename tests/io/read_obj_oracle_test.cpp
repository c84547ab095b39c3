// What a reader written by others makes of the same files: tinyobjloader, in double precision.
#define TINYOBJLOADER_IMPLEMENTATION
#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>

#include <algorithm>
#include <vector>

#include "io/scene_files.h"

namespace luxel {
namespace {

struct Oracle {
  tinyobj::attrib_t points;
  std::vector<int> offsets{0}, corners;
  std::vector<tinyobj::material_t> materials;
};

Oracle oracle_of(const std::filesystem::path& file) {
  Oracle oracle;
  std::vector<tinyobj::shape_t> shapes;
  std::string warning, error;
  const std::string folder = file.parent_path().string() + "/";
  constexpr bool triangulate = false;
  EXPECT_TRUE(tinyobj::LoadObj(&oracle.points, &shapes, &oracle.materials, &warning, &error,
                               file.string().c_str(), folder.c_str(), triangulate))
      << error;
  for (const tinyobj::shape_t& shape : shapes) {
    for (const auto& index : shape.mesh.indices) oracle.corners.push_back(index.vertex_index);
    for (const auto count : shape.mesh.num_face_vertices)
      oracle.offsets.push_back(oracle.offsets.back() + count);
  }
  return oracle;
}

void expect_equal(const std::filesystem::path& file) {
  const Scene scene = read_scene(file);
  const Oracle oracle = oracle_of(file);

  EXPECT_EQ(scene.face_offsets, oracle.offsets) << file;
  EXPECT_EQ(scene.face_vertices, oracle.corners) << file;
  ASSERT_EQ(3 * scene.vertices.size(), oracle.points.vertices.size()) << file;
  for (std::size_t i = 0; i < oracle.points.vertices.size(); ++i) {
    const double expected = oracle.points.vertices[i];
    // tinyobjloader multiplies digits by powers of ten and may miss the nearest double by a few roundings.
    EXPECT_NEAR(scene.vertices[i / 3][static_cast<int>(i % 3)], expected, 1e-15 * std::abs(expected)) << file;
  }
}

TEST(ReadObjOracle, AgreesOnEveryMeshOfTheTests) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(LUXEL_TEST_DATA) + "/obj")) {
    expect_equal(entry.path());
    ++files;
  }
  EXPECT_EQ(files, 50);
}

TEST(ReadObjOracle, AgreesOnTheCornellBoxAndItsMaterials) {
  const std::filesystem::path file =
      std::filesystem::path(LUXEL_TEST_DATA) / "../../examples/scenes/cornell/cornell.obj";
  expect_equal(file);
  const Scene scene = read_scene(file, {.emission_unit = EmissionUnit::Exitance});
  const Oracle oracle = oracle_of(file);

  for (int f = 0; f < scene.face_count(); ++f) {
    const auto material =
        std::find_if(oracle.materials.begin(), oracle.materials.end(),
                     [&](const tinyobj::material_t& m) { return m.name == testing::material_of(scene, f); });
    ASSERT_NE(material, oracle.materials.end());
    for (int channel = 0; channel < 3; ++channel) {
      // As above.
      EXPECT_NEAR(testing::finish_of(scene, f).reflectance[channel], material->diffuse[channel], 1e-15);
      EXPECT_NEAR(testing::finish_of(scene, f).emission[channel], material->emission[channel], 2e-14);
    }
  }
}

}  // namespace
}  // namespace luxel
