#include "transport/gather/shadow_rays.h"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sampling/owen_sobol.h"
#include "sampling/sobol_words.h"
#include "transport/gather/front_part.h"

namespace luxel {

namespace {

constexpr int packet = 16;

// Rays end this far in front of the lamp, in the ray scene's coordinates: above the rounding of float.
constexpr double lamp_offset = 4e-7;

// A lamp that fills little of its frame gets more points, so many times at most.
constexpr double most_points = 4;

// Nearer than this, in roots of the patch's area, lamps are also looked for by rays drawn by the cosine:
// where lamp and patch touch, pairs of points have weights of infinite variance.
constexpr double close = 2;

constexpr std::uint64_t direction_stream = 0x64697265;

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

float dot(const RayPoint& a, const RayPoint& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// One look at a lamp from a patch.
class Look {
 public:
  Look(const PatchFrame& patch, const Lamp& lamp, std::uint64_t seed)
      : lamp_(lamp),
        receiver_(front_part(patch, lamp)),
        source_(front_part(lamp, patch)),
        close_(is_close(patch, lamp)),
        normal_(lowered(patch.normal)),
        lamp_normal_(lowered(lamp.normal)),
        offset_(static_cast<float>(lamp.offset + lamp_offset)) {
    for (int d = 0; d < 4; ++d) {
      seeds_[0][d] = static_cast<std::uint32_t>(mixed_seed(seed, d));
      seeds_[1][d] = static_cast<std::uint32_t>(mixed_seed(seed ^ direction_stream, d));
    }
    const Vec3 tangent = patch.normal.unitOrthogonal();
    tangent_ = lowered(tangent);
    bitangent_ = lowered(patch.normal.cross(tangent));
  }

  LampView view(RTCScene scene, int count, const std::uint32_t* words) {
    if (receiver_.empty() || source_.empty()) return {};
    // how much of a part of the frame is lamp is not known: rays are counted instead
    const bool counted = !source_.whole() && !lamp_.fills_frame;
    const int points = static_cast<int>(
        std::ceil(count * (counted ? most_points : std::min(most_points, 1 / lamp_.filled))));
    for (int begin = 0; begin < points && (!counted || view_.rays < count); begin += packet) {
      const int some = std::min(packet, points - begin);
      cast(scene, some, words + 4 * static_cast<std::size_t>(begin), false);
      if (close_) cast(scene, some, words + 4 * static_cast<std::size_t>(begin), true);
    }
    view_.share = all_ > 0 ? lit_ / all_ : 0;
    return view_;
  }

 private:
  /// Rays from `some` points of the patch, to points of the lamp or drawn by the cosine.
  void cast(RTCScene scene, int some, const std::uint32_t* words, bool by_cosine) {
    RTCRay16 rays;
    std::array<double, packet> weights;
    alignas(64) std::array<int, packet> valid{};
    const LaineKarras scramble;
    int active = 0;
    for (int k = 0; k < some; ++k) {
      const auto fraction = [&](int d) {
        const std::uint32_t word = bits_reversed(scramble(words[4 * k + d], seeds_[by_cosine][d]));
        return static_cast<float>(static_cast<int>(word >> 8)) * 0x1p-24f;
      };
      const RayPoint from = receiver_.point(fraction(0), fraction(1));
      const RayPoint to =
          by_cosine ? met_by_cosine(from, fraction(2), fraction(3)) : source_.point(fraction(2), fraction(3));
      const RayPoint way = {to.x - from.x, to.y - from.y, to.z - from.z};
      weights[k] = weight(way);
      if (!(weights[k] > 0)) continue;
      if ((by_cosine || !lamp_.fills_frame) && !lamp_.holds(Vec3(to.x, to.y, to.z))) continue;
      valid[k] = -1;
      ++active;
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
    if (active == 0) return;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcOccluded16(valid.data(), scene, &context, &rays);
    view_.rays += active;
    for (int k = 0; k < some; ++k) {
      if (!valid[k]) continue;
      const bool hidden = rays.tfar[k] < 0;
      all_ += weights[k];
      if (!hidden) lit_ += weights[k];
      (hidden ? view_.some_hidden : view_.some_lit) = true;
    }
  }

  /// Where a ray meets the lamp's plane; the point itself where it does not.
  RayPoint met_by_cosine(const RayPoint& from, float s, float t) const {
    const float angle = 2 * std::numbers::pi_v<float> * t, radius = std::sqrt(s), height = std::sqrt(1 - s);
    const float x = radius * std::cos(angle), y = radius * std::sin(angle);
    const RayPoint direction = {x * tangent_.x + y * bitangent_.x + height * normal_.x,
                                x * tangent_.y + y * bitangent_.y + height * normal_.y,
                                x * tangent_.z + y * bitangent_.z + height * normal_.z};
    const float towards = -dot(direction, lamp_normal_);
    if (!(towards > 0)) return from;
    const float distance = (dot(from, lamp_normal_) - offset_) / towards;
    return {from.x + distance * direction.x, from.y + distance * direction.y,
            from.z + distance * direction.z};
  }

  /// What a pair of points would carry, over the density of such pairs among all that are drawn: the balance
  /// heuristic (Veach and Guibas 1995). 0 where either looks away.
  double weight(const RayPoint& way) const {
    const double cosine = dot(way, normal_), lamp_cosine = -dot(way, lamp_normal_), square = dot(way, way);
    if (!(cosine > 0 && lamp_cosine > 0)) return 0;
    const double kernel = cosine * lamp_cosine / (std::numbers::pi * square * square);
    return close_ ? kernel / (kernel + 1 / source_.area()) : kernel;
  }

  const Lamp& lamp_;
  FrontPart receiver_, source_;
  bool close_;
  RayPoint normal_, tangent_, bitangent_, lamp_normal_;
  float offset_;
  std::array<std::array<std::uint32_t, 4>, 2> seeds_;
  LampView view_;
  double all_ = 0, lit_ = 0;
};

}  // namespace

bool is_close(const PatchFrame& patch, const Lamp& lamp) {
  const Vec3 first = (patch.first + patch.second) / 3, other = (patch.second + patch.third) / 3;
  const Vec3 middle = patch.corner + patch.share * first + (1 - patch.share) * other;
  const double area = (patch.first.cross(patch.second).norm() + patch.second.cross(patch.third).norm()) / 2;
  return lamp.distance(middle) < close * std::sqrt(area);
}

ShadowRays::ShadowRays(const RayScene& occluders, int most)
    : scene_(occluders.embree_scene()),
      words_(reversed_sobol_words(static_cast<int>(std::ceil(most * most_points)) + packet)) {}

LampView ShadowRays::view(const PatchFrame& patch, const Lamp& lamp, int count, std::uint64_t seed) const {
  return Look(patch, lamp, seed).view(static_cast<RTCScene>(scene_), count, words_.data());
}

}  // namespace luxel
