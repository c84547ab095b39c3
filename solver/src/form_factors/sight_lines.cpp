#include "form_factors/sight_lines.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "form_factors/occluder_set.h"
#include "sampling/owen_sobol.h"
#include "sampling/sobol_words.h"

namespace luxel {

namespace {

// Lines start and end this far in front of their patches, in working coordinates: above the rounding of a
// coordinate in float (6e-8) and of a plane through such corners, below the thinnest wall (1e-6).
constexpr double surface_offset = 4e-7;

// Points of the sequence that are kept at hand; hardly a pair needs more.
constexpr int kept_points = 4096;

const std::vector<std::uint32_t>& kept_words() {
  static const std::vector<std::uint32_t> words = reversed_sobol_words(kept_points);
  return words;
}

// Point of a convex polygon: with the density of the bilinear map for quads, whose area element is in
// `stretch`; uniform by area else.
struct PatchPoint {
  Vec3 at;
  double stretch;
};

PatchPoint point_on_triangle(const Vec3& a, const Vec3& b, const Vec3& c, double u, double v) {
  const double root = std::sqrt(u);
  return {(1 - root) * a + root * (1 - v) * b + root * v * c, 1};
}

PatchPoint point_on(const Polygon& p, double u, double v) {
  if (p.count == 3) return point_on_triangle(p[0], p[1], p[2], u, v);
  if (p.count == 4) {
    const Vec3 along_u = (1 - v) * (p[1] - p[0]) + v * (p[2] - p[3]);
    const Vec3 along_v = (1 - u) * (p[3] - p[0]) + u * (p[2] - p[1]);
    return {(1 - u) * (1 - v) * p[0] + u * (1 - v) * p[1] + u * v * p[2] + (1 - u) * v * p[3],
            along_u.cross(along_v).norm()};
  }
  // the triangle of the fan in which u times the area falls, and where in it
  const double whole = area_vector(p).norm();
  double left = u * whole;
  for (int k = 1; k + 1 < p.count; ++k) {
    const double part = 0.5 * (p[k] - p[0]).cross(p[k + 1] - p[0]).norm();
    if (left <= part || k + 2 == p.count) {
      return point_on_triangle(p[0], p[k], p[k + 1], std::min(part > 0 ? left / part : 0.0, 1.0), v);
    }
    left -= part;
  }
  return {p[0], 1};
}

bool straddles(const WorkPatch& patch, const Plane& plane) {
  return span_along(patch.outline, plane).low < -side_tolerance;
}

}  // namespace

SightLine sight_line(const WorkPatch& a, const Vec3& from, const WorkPatch& b, const Vec3& to) {
  const Vec3 sight = to - from;
  const double along_a = sight.dot(a.plane.normal), along_b = -sight.dot(b.plane.normal);
  if (along_a <= 0 || along_b <= 0) return {};
  const double squared = sight.squaredNorm();
  return {from + surface_offset * a.plane.normal, to + surface_offset * b.plane.normal,
          along_a * along_b / (squared * squared)};
}

SightLines::SightLines(const WorkPatch& a, const WorkPatch& b, std::uint64_t seed)
    : a_(&a), b_(&b), words_(kept_words().data()) {
  const auto i = static_cast<std::uint64_t>(a.patch), j = static_cast<std::uint64_t>(b.patch);
  seed_ = mixed_seed(seed, i << 32 | j);
  const std::uint64_t more = mixed_seed(seed_, 1);
  seeds_ = {static_cast<std::uint32_t>(seed_), static_cast<std::uint32_t>(seed_ >> 32),
            static_cast<std::uint32_t>(more), static_cast<std::uint32_t>(more >> 32)};
}

SightLine SightLines::operator[](int k) const {
  std::array<double, 4> u;
  if (k < kept_points) {
    const std::uint32_t* words = words_ + 4 * static_cast<std::size_t>(k);
    for (std::size_t c = 0; c < 4; ++c) u[c] = bits_reversed(LaineKarras{}(words[c], seeds_[c])) * 0x1p-32;
  } else {
    u = OwenSobol4(seed_)(static_cast<std::uint32_t>(k));
  }
  const PatchPoint x = point_on(a_->outline, u[0], u[1]), y = point_on(b_->outline, u[2], u[3]);
  SightLine line = sight_line(*a_, x.at, *b_, y.at);
  line.weight *= x.stretch * y.stretch;
  return line;
}

FacingParts facing_parts(const WorkPatch& a, const WorkPatch& b) {
  FacingParts parts;
  if (!straddles(a, b.plane) && !straddles(b, a.plane)) return parts;
  const Polygon from = clip(a.outline, b.plane, side_tolerance),
                to = clip(b.outline, a.plane, side_tolerance);
  if (from.count < 3 || to.count < 3) return parts;
  parts.clipped = true;
  parts.a = a;
  parts.b = b;
  parts.a.outline = from;
  parts.b.outline = to;
  return parts;
}

}  // namespace luxel
