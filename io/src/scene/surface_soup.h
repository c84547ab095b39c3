#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "luxel/vector.h"

namespace luxel {

/// What a mesh file states about a surface; what it leaves open stays empty.
struct StatedFinish {
  std::string name;                ///< of the material that states it; empty for a face's own values
  std::optional<Rgb> reflectance;  ///< each channel in [0, 1]
  std::optional<Rgb> emission;     ///< exitance E [W/m2], >= 0
  std::optional<bool> two_sided;
};

/// What every mesh format is read into: polygons with names and stated finishes, lengths as in the file.
/// Every number is finite and every index in range.
struct SurfaceSoup {
  std::vector<Vec3> vertices;
  std::vector<int> face_offsets{0};    ///< F + 1, as Scene::face_offsets
  std::vector<int> face_vertices;      ///< counter-clockwise seen from the front
  std::vector<int> face_groups;        ///< F indices into `groups`
  std::vector<int> face_materials;     ///< F indices into `materials`
  std::vector<int> face_stated;        ///< F indices into `stated`
  std::vector<std::string> groups;     ///< in order of first use
  std::vector<std::string> materials;  ///< in order of first use by a face
  std::vector<StatedFinish> stated;    ///< also those that no face uses
  std::vector<std::string> warnings;

  std::size_t face_count() const { return face_offsets.size() - 1; }
};

/// The most that a surface may emit, whatever its unit: squares and sums over a scene must not overflow.
inline constexpr double largest_emission = 1e100;

/// The name of the group or material of faces for which a file gives none.
inline constexpr std::string_view default_name = "default";

}  // namespace luxel
