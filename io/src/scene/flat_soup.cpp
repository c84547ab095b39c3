#include "scene/flat_soup.h"

#include <algorithm>

namespace luxel {
namespace {

// Stands for "not stated" in the table of statements; no reflectance or emission is negative.
constexpr double not_stated = -1;

}  // namespace

void FlatSoup::begin_group(std::string_view name) {
  const std::string_view shown = name.empty() ? default_name : name;
  const auto found = std::find(soup_.groups.begin(), soup_.groups.end(), shown);
  group_ = static_cast<int>(found - soup_.groups.begin());
  if (found == soup_.groups.end()) soup_.groups.emplace_back(shown);
}

void FlatSoup::add_face(std::span<const int> corners, const std::optional<Rgb>& reflectance,
                        const std::optional<Rgb>& emission) {
  if (group_ < 0) begin_group(default_name);
  const Rgb rho = reflectance.value_or(Rgb::Constant(not_stated));
  const Rgb e = emission.value_or(Rgb::Constant(not_stated));
  const auto [entry, is_new] =
      stated_.try_emplace({rho[0], rho[1], rho[2], e[0], e[1], e[2]}, static_cast<int>(soup_.stated.size()));
  if (is_new) soup_.stated.push_back({"", reflectance, emission, std::nullopt});
  soup_.face_vertices.insert(soup_.face_vertices.end(), corners.begin(), corners.end());
  soup_.face_offsets.push_back(static_cast<int>(soup_.face_vertices.size()));
  soup_.face_groups.push_back(group_);
  soup_.face_materials.push_back(0);
  soup_.face_stated.push_back(entry->second);
}

SurfaceSoup FlatSoup::take() {
  soup_.materials = {std::string(default_name)};
  return std::move(soup_);
}

}  // namespace luxel
