#include "transport/gather/lamp_light.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace luxel {

namespace {

// One point of a patch stands for all where the lamp is farther than this, in roots of its area; three
// do down to the second distance, below it three in each of 16 parts.
constexpr double far = 30, near = 2;
constexpr int parts_when_near = 4, parts_when_cut = 4;  // a side

// Corners nearer than this to a plane, in the ray scene's coordinates, lie on it: above margin and rounding.
constexpr double touching = 1e-5;

/// Mean of a lamp's unoccluded form factor over a triangle, by the three-point rule in parts x parts parts.
double mean_over_triangle(const std::array<Vec3, 3>& x, const Vec3& normal, const Lamp& lamp, int parts) {
  const Vec3 u = (x[1] - x[0]) / parts, v = (x[2] - x[0]) / parts;
  double sum = 0;
  const auto add = [&](const Vec3& corner, double sign) {
    for (const auto& [s, t] : {std::array{1.0 / 6, 1.0 / 6}, {2.0 / 3, 1.0 / 6}, {1.0 / 6, 2.0 / 3}}) {
      sum += form_factor(corner + sign * (s * u + t * v), normal, lamp);
    }
  };
  for (int i = 0; i < parts; ++i) {
    for (int j = 0; i + j < parts; ++j) {
      add(x[0] + i * u + j * v, 1);
      if (i + j + 1 < parts) add(x[0] + (i + 1) * u + (j + 1) * v, -1);
    }
  }
  return sum / (3 * parts * parts);
}

/// Triangles repeat their last.
std::array<Vec3, 4> corners_of(const PatchFrame& patch) {
  return {patch.corner, patch.corner + patch.first, patch.corner + patch.second,
          patch.corner + (patch.share < 1 ? patch.third : patch.second)};
}

/// Whether the plane of the one has points of the other on both of its sides.
bool cuts(const PatchFrame& patch, const Lamp& lamp) {
  const auto across = [](const auto& heights) {
    const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
    return *low<-touching&& * high> touching;
  };
  std::vector<double> heights;
  for (const Vec3& x : corners_of(patch)) heights.push_back(lamp.normal.dot(x) - lamp.offset);
  if (across(heights)) return true;
  heights.clear();
  for (const auto& edge : lamp.outline) heights.push_back(patch.normal.dot(edge[0] - patch.corner));
  return across(heights);
}

}  // namespace

double unoccluded(const PatchFrame& patch, double area, const Lamp& lamp) {
  const Vec3 corner = patch.corner, b = corner + patch.first, c = corner + patch.second;
  const bool quad = patch.share < 1;
  const Vec3 d = quad ? Vec3(corner + patch.third) : c;
  const Vec3 first = (corner + b + c) / 3, other = (corner + c + d) / 3;
  const Vec3 middle = quad ? Vec3(patch.share * first + (1 - patch.share) * other) : first;
  const double reach = lamp.distance(middle) / std::sqrt(area);
  if (reach > far) return form_factor(middle, patch.normal, lamp);
  // a patch that the plane of the lamp cuts, or the lamp that of the patch, sees a kink
  int parts = reach > near ? 1 : parts_when_near;
  if (parts == 1 && cuts(patch, lamp)) parts = parts_when_cut;
  const double mean = mean_over_triangle({corner, b, c}, patch.normal, lamp, parts);
  if (!quad) return mean;
  return patch.share * mean +
         (1 - patch.share) * mean_over_triangle({corner, c, d}, patch.normal, lamp, parts);
}

bool faces(const PatchFrame& patch, const Lamp& lamp) {
  const std::array<Vec3, 4> corners = corners_of(patch);
  const bool in_front = std::any_of(corners.begin(), corners.end(),
                                    [&](const Vec3& x) { return lamp.normal.dot(x) > lamp.offset; });
  return in_front && std::any_of(lamp.outline.begin(), lamp.outline.end(), [&](const auto& edge) {
           return patch.normal.dot(edge[0] - patch.corner) > 0;
         });
}

}  // namespace luxel
