#include "scene/mesh_formats.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <system_error>

#include "scene/gltf_reader.h"
#include "scene/input_location.h"
#include "scene/obj_reader.h"
#include "scene/off_reader.h"
#include "scene/ply_reader.h"
#include "scene/stl_reader.h"

namespace luxel {
namespace {

constexpr std::array formats{
    MeshFormat{".obj", read_obj}, MeshFormat{".ply", read_ply},   MeshFormat{".stl", read_stl},
    MeshFormat{".off", read_off}, MeshFormat{".gltf", read_gltf}, MeshFormat{".glb", read_gltf},
};

}  // namespace

std::span<const MeshFormat> mesh_formats() {
  return formats;
}

std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

void refuse_extension(const std::filesystem::path& file, const std::vector<std::string>& known) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) refuse({file}, "no such file");
  if (std::filesystem::is_directory(file, error)) refuse({file}, "is a directory; expected a file");
  const std::string extension = lower_extension(file);
  std::string message = extension.empty() ? "no extension" : "extension " + in_quotes(extension);
  message += "; expected";
  for (const std::string& one : known) message += " " + one;
  refuse({file}, message);
}

SurfaceSoup read_mesh(const std::filesystem::path& file, const ReadOptions& options) {
  const std::string extension = lower_extension(file);
  std::vector<std::string> known;
  for (const MeshFormat& format : formats) {
    if (extension == format.extension) return format.read(file, options);
    known.emplace_back(format.extension);
  }
  refuse_extension(file, known);
}

}  // namespace luxel
