#include "transport/gather/shadow_rays.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>

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

// The part of a lamp's frame, in its own coordinates, around what lies above the plane of a patch: of a lamp
// that reaches far behind the patch, points of the whole frame would hardly meet what the patch sees.
struct Window {
  double s = 0, t = 0, width = 1, height = 1;
  bool whole = true;
};

Window window_above(const PatchFrame& patch, const Lamp& lamp) {
  const auto height = [&](const Vec3& x) { return patch.normal.dot(x - patch.corner); };
  const double aa = lamp.along.squaredNorm(), uu = lamp.up.squaredNorm(), au = lamp.along.dot(lamp.up);
  const double determinant = aa * uu - au * au;
  double low_s = 1, low_t = 1, high_s = 0, high_t = 0;
  bool cut = false;
  const auto include = [&](const Vec3& x) {
    const Vec3 from = x - lamp.corner;
    const double a = from.dot(lamp.along), u = from.dot(lamp.up);
    const double s = (a * uu - u * au) / determinant, t = (u * aa - a * au) / determinant;
    low_s = std::min(low_s, s);
    low_t = std::min(low_t, t);
    high_s = std::max(high_s, s);
    high_t = std::max(high_t, t);
  };
  for (const auto& [from, to] : lamp.outline) {
    const double here = height(from), there = height(to);
    cut = cut || here < 0;
    if (here > 0) include(from);
    if ((here > 0) != (there > 0)) include(from + here / (here - there) * (to - from));
  }
  Window window;
  if (!cut || !(determinant > 0)) return window;
  window.s = std::clamp(low_s, 0.0, 1.0);
  window.t = std::clamp(low_t, 0.0, 1.0);
  window.width = std::clamp(high_s, 0.0, 1.0) - window.s;
  window.height = std::clamp(high_t, 0.0, 1.0) - window.t;
  window.whole = !(window.width > 0 && window.height > 0);
  return window.whole ? Window() : window;
}

void fold(float& s, float& t) {
  const float half_s = s / 2, half_t = t / 2;
  const bool above = t > s;
  s = above ? half_s : s - half_t;
  t = above ? t - half_s : half_t;
}

}  // namespace

ShadowRays::ShadowRays(const RayScene& occluders, int most)
    : scene_(occluders.embree_scene()),
      words_(reversed_sobol_words(static_cast<int>(std::ceil(most * most_points)) + packet)) {}

LampView ShadowRays::view(const PatchFrame& patch, const Lamp& lamp, int count, std::uint64_t seed) const {
  const Point corner = lowered(patch.corner), first = lowered(patch.first), second = lowered(patch.second),
              third = lowered(patch.third), normal = lowered(patch.normal);
  const Point lamp_corner = lowered(lamp.corner + lamp_offset * lamp.normal), along = lowered(lamp.along),
              up = lowered(lamp.up), lamp_normal = lowered(lamp.normal);
  const auto share = static_cast<float>(patch.share);
  std::array<std::uint32_t, 4> seeds;
  for (int d = 0; d < 4; ++d) seeds[d] = static_cast<std::uint32_t>(mixed_seed(seed, d));
  const Window window = window_above(patch, lamp);
  const auto low_u = static_cast<float>(window.s), low_v = static_cast<float>(window.t);
  const auto width = static_cast<float>(window.width), height = static_cast<float>(window.height);
  // how much of a window is lamp is not known: rays are counted instead
  const int points = static_cast<int>(
      std::ceil(count * (window.whole ? std::min(most_points, 1 / lamp.filled) : most_points)));

  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  RTCRay16 rays;
  std::array<float, packet> weights;
  alignas(64) std::array<int, packet> valid;
  const LaineKarras scramble;
  LampView result;
  double all = 0, lit = 0;
  for (int begin = 0; begin < points && (window.whole || result.rays < count); begin += packet) {
    int active = 0;
    for (int k = 0; k < packet; ++k) {
      const std::uint32_t* words = &words_[4 * static_cast<std::size_t>(begin + k)];
      const auto fraction = [&](int d) {
        return static_cast<float>(static_cast<int>(bits_reversed(scramble(words[d], seeds[d])) >> 8)) *
               0x1p-24f;
      };
      float s = fraction(0), t = fraction(1), u = fraction(2), v = fraction(3);
      const bool in_first = s < share;
      s = in_first ? s / share : (s - share) / (1 - share);
      fold(s, t);
      const Point from = moved(corner, s, in_first ? first : second, t, in_first ? second : third);
      if (window.whole) {
        if (lamp.triangle) fold(u, v);
      } else {
        u = low_u + u * width;
        v = low_v + v * height;
      }
      const Point to = moved(lamp_corner, u, along, v, up);
      const Point way = {to.x - from.x, to.y - from.y, to.z - from.z};
      const float square = dot(way, way), cosine = dot(way, normal), lamp_cosine = -dot(way, lamp_normal);
      const bool beyond = lamp.triangle && u + v > 1;
      const bool faces = begin + k < points && cosine > 0 && lamp_cosine > 0 && !beyond &&
                         (lamp.fills_frame || lamp.holds(lamp.corner + u * lamp.along + v * lamp.up));
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
