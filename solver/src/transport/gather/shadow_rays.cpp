#include "transport/gather/shadow_rays.h"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>

#include "form_factors/polygon.h"
#include "sampling/owen_sobol.h"
#include "sampling/sobol_words.h"

namespace luxel {

namespace {

constexpr int packet = 16;

// Rays end this far in front of the lamp, in the ray scene's coordinates: above the rounding of float.
constexpr float lamp_offset = 4e-7f;

// A lamp that fills little of its frame gets more points, so many times at most.
constexpr double most_points = 4;

struct Point {
  float x, y, z;
};

Point lowered(const Vec3& x) {
  return {static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2])};
}

Point moved(const Point& x, float s, const Point& a, float t, const Point& b) {
  return {x.x + s * a.x + t * b.x, x.y + s * a.y + t * b.y, x.z + s * a.z + t * b.z};
}

float dot(const Point& a, const Point& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

// The square folded onto a triangle, which keeps neighbours together (Heitz 2019).
void fold(float& s, float& t) {
  const float half_s = s / 2, half_t = t / 2;
  const bool above = t > s;
  s = above ? half_s : s - half_t;
  t = above ? t - half_s : half_t;
}

// The part of a flat polygon in front of a plane, and its points by numbers of the unit square: only what
// lies above each other's horizon can exchange light, and of a patch or a lamp that is mostly behind, points
// of the whole would hardly meet it.
class FrontPart {
 public:
  /// @param parallelogram  four corners, of which the last is the first plus the third less the second
  FrontPart(const Polygon& outline, const Plane& plane, bool parallelogram) {
    whole_ = span_along(outline, plane).low >= 0;
    const Polygon part = whole_ ? outline : clip(outline, plane, 0);
    if (whole_ && parallelogram) {
      add(part[0], part[1], part[3]);
      square_ = true;
      return;
    }
    std::array<double, most> areas{};
    double area = 0;
    for (int k = 0; k + 2 < part.count; ++k) {
      areas[k] = (part[k + 1] - part[0]).cross(part[k + 2] - part[0]).norm();
      area += areas[k];
      add(part[0], part[k + 1], part[k + 2]);
    }
    if (!(area > 0)) count_ = 0;
    for (int k = 0; k < count_; ++k) shares_[k] = static_cast<float>(areas[k] / area);
  }

  bool empty() const { return count_ == 0; }
  bool whole() const { return whole_; }

  Point point(float s, float t) const {
    int k = 0;
    if (!square_) {
      for (; k + 1 < count_ && s >= shares_[k]; ++k) s -= shares_[k];
      s = shares_[k] > 0 ? std::min(s / shares_[k], 1.0F) : 0;
      fold(s, t);
    }
    return moved(triangles_[k].corner, s, triangles_[k].first, t, triangles_[k].second);
  }

 private:
  static constexpr int most = 3;  // a quad cut by one plane
  struct Triangle {
    Point corner, first, second;
  };

  void add(const Vec3& corner, const Vec3& first, const Vec3& second) {
    triangles_[count_++] = {lowered(corner), lowered(first - corner), lowered(second - corner)};
  }

  int count_ = 0;
  bool whole_ = false, square_ = false;
  std::array<Triangle, most> triangles_;
  std::array<float, most> shares_;
};

FrontPart front_part(const PatchFrame& patch, const Lamp& lamp) {
  const Vec3& a = patch.corner;
  return FrontPart({patch.share < 1 ? 4 : 3, {a, a + patch.first, a + patch.second, a + patch.third}},
                   {lamp.normal, lamp.offset}, false);
}

FrontPart front_part(const Lamp& lamp, const PatchFrame& patch) {
  const Vec3 a = lamp.corner + lamp_offset * lamp.normal, b = a + lamp.along, d = a + lamp.up;
  const Plane plane{patch.normal, patch.normal.dot(patch.corner)};
  return lamp.triangle ? FrontPart({3, {a, b, d}}, plane, false)
                       : FrontPart({4, {a, b, b + lamp.up, d}}, plane, true);
}

}  // namespace

ShadowRays::ShadowRays(const RayScene& occluders, int most)
    : scene_(occluders.embree_scene()),
      words_(reversed_sobol_words(static_cast<int>(std::ceil(most * most_points)) + packet)) {}

LampView ShadowRays::view(const PatchFrame& patch, const Lamp& lamp, int count, std::uint64_t seed) const {
  LampView result;
  const FrontPart receiver = front_part(patch, lamp), source = front_part(lamp, patch);
  if (receiver.empty() || source.empty()) return result;
  const Point normal = lowered(patch.normal), lamp_normal = lowered(lamp.normal);
  std::array<std::uint32_t, 4> seeds;
  for (int d = 0; d < 4; ++d) seeds[d] = static_cast<std::uint32_t>(mixed_seed(seed, d));
  // how much of a part of the frame is lamp is not known: rays are counted instead
  const bool counted = !source.whole() && !lamp.fills_frame;
  const int points =
      static_cast<int>(std::ceil(count * (counted ? most_points : std::min(most_points, 1 / lamp.filled))));

  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  RTCRay16 rays;
  std::array<float, packet> weights;
  alignas(64) std::array<int, packet> valid;
  const LaineKarras scramble;
  double all = 0, lit = 0;
  for (int begin = 0; begin < points && (!counted || result.rays < count); begin += packet) {
    int active = 0;
    for (int k = 0; k < packet; ++k) {
      const std::uint32_t* words = &words_[4 * static_cast<std::size_t>(begin + k)];
      const auto fraction = [&](int d) {
        return static_cast<float>(static_cast<int>(bits_reversed(scramble(words[d], seeds[d])) >> 8)) *
               0x1p-24f;
      };
      const Point from = receiver.point(fraction(0), fraction(1));
      const Point to = source.point(fraction(2), fraction(3));
      const Point way = {to.x - from.x, to.y - from.y, to.z - from.z};
      const float square = dot(way, way), cosine = dot(way, normal), lamp_cosine = -dot(way, lamp_normal);
      const bool faces = begin + k < points && cosine > 0 && lamp_cosine > 0 &&
                         (lamp.fills_frame || lamp.holds(Vec3(to.x, to.y, to.z)));
      weights[k] = faces ? cosine * lamp_cosine / (square * square) : 0;
      valid[k] = faces ? -1 : 0;
      active += faces;
      rays.org_x[k] = from.x;
      rays.org_y[k] = from.y;
      rays.org_z[k] = from.z;
      rays.dir_x[k] = way.x;
      rays.dir_y[k] = way.y;
      rays.dir_z[k] = way.z;
      rays.tnear[k] = 0;
      rays.tfar[k] = 1;
      rays.time[k] = 0;
      rays.mask[k] = ~0u;
      rays.id[k] = 0;
      rays.flags[k] = 0;
    }
    if (active == 0) continue;
    rtcOccluded16(valid.data(), static_cast<RTCScene>(scene_), &context, &rays);
    result.rays += active;
    for (int k = 0; k < packet; ++k) {
      if (!valid[k]) continue;
      const bool hidden = rays.tfar[k] < 0;
      all += weights[k];
      if (!hidden) lit += weights[k];
      (hidden ? result.some_hidden : result.some_lit) = true;
    }
  }
  result.share = all > 0 ? lit / all : 0;
  return result;
}

}  // namespace luxel
