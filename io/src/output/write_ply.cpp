#include "luxel/write_ply.h"

#include <bit>
#include <cstring>
#include <stdexcept>
#include <string>

#include "display_colours.h"
#include "luxel/write_file.h"

namespace luxel {

namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian");

// Bytes gathered before they go to the file
constexpr std::size_t buffer_size = 1 << 20;

class BinaryWriter {
 public:
  explicit BinaryWriter(OutputFile& file) : file_(file) { buffer_.reserve(buffer_size + 64); }

  template <class Value>
  void put(Value value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    buffer_.append(bytes, sizeof value);
    if (buffer_.size() >= buffer_size) flush();
  }

  void flush() {
    file_.write(buffer_);
    buffer_.clear();
  }

 private:
  OutputFile& file_;
  std::string buffer_;
};

std::string header(std::size_t vertices, std::size_t faces) {
  std::string text = "ply\nformat binary_little_endian 1.0\ncomment radiosity in W/m^2, lengths in m\n";
  text += "element vertex " + std::to_string(vertices) + "\n";
  for (const char* name : {"x", "y", "z"}) text.append("property double ").append(name).append("\n");
  for (const char* name : {"nx", "ny", "nz", "radiosity_r", "radiosity_g", "radiosity_b"}) {
    text.append("property float ").append(name).append("\n");
  }
  for (const char* name : {"red", "green", "blue"}) text.append("property uchar ").append(name).append("\n");
  text += "element face " + std::to_string(faces) + "\n";
  return text +
         "property list uchar int vertex_indices\nproperty int material\nproperty int group\nend_header\n";
}

}  // namespace

void write_ply(const std::filesystem::path& path, const PatchMesh& mesh, const GouraudMesh& gouraud,
               const PatchField& vertex_radiosity) {
  if (static_cast<std::size_t>(vertex_radiosity.rows()) != gouraud.vertices.size() ||
      vertex_radiosity.cols() != 3) {
    throw std::invalid_argument("write_ply: radiosity is not one row per Gouraud vertex by 3");
  }
  // the vertices stand for the patches around them
  const ToneMap tone_map = tone_map_for(std::span<const double>(luminances(vertex_radiosity)));
  const auto colours = display_colours(vertex_radiosity, tone_map);

  OutputFile file(path);
  file.write(header(gouraud.vertices.size(), gouraud.corners.size()));
  BinaryWriter binary(file);
  for (std::size_t v = 0; v < gouraud.vertices.size(); ++v) {
    for (int k = 0; k < 3; ++k) binary.put(gouraud.vertices[v][k]);
    for (int k = 0; k < 3; ++k) binary.put(static_cast<float>(gouraud.normals[v][k]));
    for (int k = 0; k < 3; ++k) binary.put(static_cast<float>(vertex_radiosity(v, k)));
    for (int k = 0; k < 3; ++k) binary.put(colours[3 * v + k]);
  }
  for (int i = 0; i < mesh.size(); ++i) {
    const auto count = static_cast<std::uint8_t>(mesh.corner_count(i));
    binary.put(count);
    for (int k = 0; k < count; ++k) binary.put(gouraud.corners[i][k]);
    binary.put(mesh.materials[i]);
    binary.put(mesh.groups[i]);
  }
  binary.flush();
  file.commit();
}

}  // namespace luxel
