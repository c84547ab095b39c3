#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "scene/surface_soup.h"

namespace luxel {

/// Fills the soup of a mesh file without materials: one material, `default`, and for each face what it states
/// itself. Equal statements stand once.
class FlatSoup {
 public:
  /// All faces to come are of this group.
  void begin_group(std::string_view name);

  std::vector<Vec3>& vertices() { return soup_.vertices; }
  std::vector<std::string>& warnings() { return soup_.warnings; }

  /// A face of the present group; corners must be in range by the time that take() is called.
  void add_face(std::span<const int> corners, const std::optional<Rgb>& reflectance = {},
                const std::optional<Rgb>& emission = {});

  std::size_t face_count() const { return soup_.face_count(); }

  SurfaceSoup take();

 private:
  SurfaceSoup soup_;
  std::map<std::array<double, 6>, int> stated_;
  int group_ = -1;
};

}  // namespace luxel
