#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "luxel/read_scene.h"
#include "scene/surface_soup.h"

namespace luxel {

/// A mesh format that can be read.
struct MeshFormat {
  std::string_view extension;  ///< with its dot, in lower case
  SurfaceSoup (*read)(const std::filesystem::path& file, const ReadOptions& options);
};

/// All of them. To add one more: write its reader and name it in the table in mesh_formats.cpp.
std::span<const MeshFormat> mesh_formats();

/// The file's extension in lower case, with its dot.
std::string lower_extension(const std::filesystem::path& file);

/// @throws InputError always: the file has none of the known extensions.
[[noreturn]] void refuse_extension(const std::filesystem::path& file, const std::vector<std::string>& known);

/// The mesh in a file, by its extension.
/// @throws InputError if there is no reader for it, naming those there are, or as the reader does.
SurfaceSoup read_mesh(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace luxel
