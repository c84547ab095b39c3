#include "transport/gather/lamp_light.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "form_factors/polygon.h"

namespace luxel {

namespace {

// One point of a patch stands for all where the lamp is farther than this, in roots of its area; three in
// each triangle do down to the second distance, and nearer the patch is cut smaller.
constexpr double far = 30, near = 2;

// Three points of a triangle and three in each of its halves that differ by less are believed; the latter are
// then right to a fraction of it, far below the noise of any gather.
constexpr double settled = 1e-3;

// Of the longest edge: a lamp that touches a patch is resolved to 1/256 of it.
constexpr int most_halvings = 16;

/// Triangles repeat their last.
std::array<Vec3, 4> corners_of(const PatchFrame& patch) {
  return {patch.corner, patch.corner + patch.first, patch.corner + patch.second,
          patch.corner + (patch.share < 1 ? patch.third : patch.second)};
}

using Triangle = std::array<Vec3, 3>;

/// Means of a lamp's unoccluded form factor over triangles of one plane.
class MeanFormFactor {
 public:
  MeanFormFactor(const PatchFrame& patch, const Lamp& lamp) : normal_(patch.normal), lamp_(lamp) {
    double height = 0;
    for (const auto& edge : lamp.outline) height = std::max(height, normal_.dot(edge[0] - patch.corner));
    smallest_ = std::min({height, lamp.along.norm(), lamp.up.norm()});
  }

  /// Of degree 2; exact enough for a lamp that is far.
  double by_three_points(const Triangle& x) const {
    const Vec3 u = x[1] - x[0], v = x[2] - x[0];
    double sum = 0;
    for (const auto& [s, t] : {std::array{1.0 / 6, 1.0 / 6}, {2.0 / 3, 1.0 / 6}, {1.0 / 6, 2.0 / 3}}) {
      sum += form_factor(x[0] + s * u + t * v, normal_, lamp_);
    }
    return sum / 3;
  }

  /// Of a triangle that the lamp's plane does not cut, however near the lamp.
  double by_halving(const Triangle& x) const { return by_halving(x, by_three_points(x), most_halvings); }

 private:
  double by_halving(const Triangle& x, double coarse, int halvings) const {
    int longest = 0;
    double length = 0;
    for (int k = 0; k < 3; ++k) {
      const double edge = (x[(k + 1) % 3] - x[k]).norm();
      if (edge > length) longest = k, length = edge;
    }
    const Vec3 &a = x[longest], &b = x[(longest + 1) % 3], &c = x[(longest + 2) % 3];
    const Vec3 half = (a + b) / 2;
    const Triangle first{a, half, c}, second{half, b, c};
    const double of_first = by_three_points(first), of_second = by_three_points(second);
    const double mean = (of_first + of_second) / 2;
    // what a lamp sends changes over its own size or its distance
    const bool resolved = length <= std::max(smallest_, lamp_.distance((a + b + c) / 3));
    if (halvings == 0 || (resolved && std::abs(mean - coarse) <= settled * mean)) return mean;
    return (by_halving(first, of_first, halvings - 1) + by_halving(second, of_second, halvings - 1)) / 2;
  }

  Vec3 normal_;
  const Lamp& lamp_;
  double smallest_;  // of the lamp's extents above the patch's plane
};

}  // namespace

double unoccluded(const PatchFrame& patch, double area, const Lamp& lamp) {
  const auto [a, b, c, d] = corners_of(patch);
  const Vec3 middle = (patch.share * (a + b + c) + (1 - patch.share) * (a + c + d)) / 3;
  const double reach = lamp.distance(middle) / std::sqrt(area);
  if (reach > far) return form_factor(middle, patch.normal, lamp);
  const MeanFormFactor mean(patch, lamp);
  Polygon outline{patch.share < 1 ? 4 : 3, {a, b, c, d}};
  const Plane plane{lamp.normal, lamp.offset};
  if (reach > near && span_along(outline, plane).low >= 0) {
    const double first = mean.by_three_points({a, b, c});
    return patch.share < 1 ? patch.share * first + (1 - patch.share) * mean.by_three_points({a, c, d})
                           : first;
  }
  // behind the plane of the lamp nothing arrives
  outline = clip(outline, plane, 0);
  double sum = 0;
  for (int k = 2; k < outline.count; ++k) {
    const Triangle part{outline[0], outline[k - 1], outline[k]};
    const double part_area = (part[1] - part[0]).cross(part[2] - part[0]).norm() / 2;
    if (part_area > 0) sum += part_area * mean.by_halving(part);
  }
  return sum / area;
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
