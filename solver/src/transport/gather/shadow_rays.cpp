#include "transport/gather/shadow_rays.h"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "rays/visible_share.h"
#include "sampling/sobol_words.h"

namespace luxel {

namespace {

// Rays end this far in front of the lamp, in the ray scene's coordinates: above the rounding of float.
constexpr double lamp_offset = 4e-7;

// A lamp that fills little of its frame gets more points, so many times at most.
constexpr double most_points = 4;

// Nearer than this, in roots of the patch's area, lamps are also looked for by rays drawn by the cosine:
// where lamp and patch touch, pairs of points have weights of infinite variance.
constexpr double close = 2;

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

bool is_close(const PatchFrame& patch, const Lamp& lamp) {
  const Vec3 first = (patch.first + patch.second) / 3, other = (patch.second + patch.third) / 3;
  const Vec3 middle = patch.corner + patch.share * first + (1 - patch.share) * other;
  const double area = (patch.first.cross(patch.second).norm() + patch.second.cross(patch.third).norm()) / 2;
  return lamp.distance(middle) < close * std::sqrt(area);
}

ShadowRays::ShadowRays(const RayScene& occluders, int most)
    : scene_(occluders.embree_scene()),
      words_(reversed_sobol_words(static_cast<int>(std::ceil(most * most_points)) + VisibleShare::packet)) {}

LampView ShadowRays::view(const PatchFrame& patch, const Lamp& lamp, int count, std::uint64_t seed) const {
  const SightEnds ends{front_part(patch, lamp),
                       front_part(lamp, patch),
                       patch.normal,
                       lamp.normal,
                       lamp.offset + lamp_offset,
                       is_close(patch, lamp),
                       lamp.fills_frame,
                       [&](const Vec3& point) { return lamp.holds(point); }};
  if (ends.receiver.empty() || ends.source.empty()) return {};
  VisibleShare visible(ends, static_cast<RTCScene>(scene_), seed);
  // how much of a part of the frame is lamp is not known: rays are counted instead
  const bool counted = !ends.source.whole() && !lamp.fills_frame;
  const int points =
      static_cast<int>(std::ceil(count * (counted ? most_points : std::min(most_points, 1 / lamp.filled))));
  constexpr int packet = VisibleShare::packet;
  for (int k = 0; k < points && (!counted || visible.rays() < count); k += packet) {
    visible.draw(std::min(packet, points - k), &words_[4 * static_cast<std::size_t>(k)]);
  }
  return {visible.share(), visible.rays(), visible.some_visible(), visible.some_hidden()};
}

}  // namespace luxel
