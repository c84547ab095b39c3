#include "luxel/write_ply.h"

#include <gtest/gtest.h>

#include <cstring>

#include "io/scratch.h"
#include "io/small_mesh.h"

namespace luxel {
namespace {

using testing::content;
using testing::Scratch;

// The next value of a binary file
template <class Value>
Value take(const std::string& bytes, std::size_t& at) {
  Value value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  at += sizeof value;
  return value;
}

TEST(WritePly, HoldsVerticesWithTheirRadiosityAndFaces) {
  const Scratch scratch;
  const PatchMesh mesh = testing::half_quad_half_triangles();
  const GouraudMesh gouraud = testing::own_vertices(mesh);
  PatchField radiosity(6, 3);
  for (int v = 0; v < 6; ++v) radiosity.row(v) << v, 0.5, 0;

  write_ply(scratch / "a.ply", mesh, gouraud, radiosity);

  const std::string bytes = content(scratch / "a.ply");
  const std::string end = "end_header\n";
  std::size_t at = bytes.find(end) + end.size();
  EXPECT_EQ(bytes.rfind("ply\nformat binary_little_endian 1.0\n", 0), 0u);
  EXPECT_NE(bytes.find("element vertex 6\n"), std::string::npos);
  EXPECT_NE(bytes.find("element face 3\n"), std::string::npos);
  for (int v = 0; v < 6; ++v) {
    for (int k = 0; k < 3; ++k) EXPECT_EQ(take<double>(bytes, at), mesh.vertices[v][k]);
    EXPECT_EQ(take<float>(bytes, at), 0);
    EXPECT_EQ(take<float>(bytes, at), 0);
    EXPECT_EQ(take<float>(bytes, at), 1);
    EXPECT_EQ(take<float>(bytes, at), static_cast<float>(v));
    EXPECT_EQ(take<float>(bytes, at), 0.5f);
    EXPECT_EQ(take<float>(bytes, at), 0);
    at += 3;
  }
  for (int i = 0; i < 3; ++i) {
    const int count = take<std::uint8_t>(bytes, at);
    EXPECT_EQ(count, mesh.corner_count(i));
    for (int k = 0; k < count; ++k) EXPECT_EQ(take<int>(bytes, at), mesh.corners[i][k]);
    EXPECT_EQ(take<int>(bytes, at), mesh.materials[i]);
    EXPECT_EQ(take<int>(bytes, at), mesh.groups[i]);
  }
  EXPECT_EQ(at, bytes.size());
}

TEST(WritePly, RefusesFieldsOfTheWrongShape) {
  const Scratch scratch;
  const PatchMesh mesh = testing::half_quad_half_triangles();

  EXPECT_THROW(write_ply(scratch / "a.ply", mesh, testing::own_vertices(mesh), PatchField(5, 3)),
               std::invalid_argument);
  EXPECT_EQ(scratch.entries(), 0);
}

}  // namespace
}  // namespace luxel
