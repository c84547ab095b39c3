#include "rays/visible_share.h"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "sampling/owen_sobol.h"
#include "sampling/sobol_words.h"

namespace luxel {

namespace {

constexpr std::uint64_t direction_stream = 0x64697265;

float dot(const RayPoint& a, const RayPoint& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

}  // namespace

VisibleShare::VisibleShare(const SightEnds& ends, RTCSceneTy* scene, std::uint64_t seed)
    : ends_(ends),
      scene_(scene),
      normal_(lowered(ends.normal)),
      source_normal_(lowered(ends.source_normal)),
      source_offset_(static_cast<float>(ends.source_offset)),
      density_(1 / ends.source.area()) {
  for (int d = 0; d < 4; ++d) {
    seeds_[0][d] = static_cast<std::uint32_t>(mixed_seed(seed, d));
    seeds_[1][d] = static_cast<std::uint32_t>(mixed_seed(seed ^ direction_stream, d));
  }
  const Vec3 tangent = ends.normal.unitOrthogonal();
  tangent_ = lowered(tangent);
  bitangent_ = lowered(ends.normal.cross(tangent));
}

void VisibleShare::draw(int count, const std::uint32_t* words) {
  cast(count, words, false);
  if (ends_.close) cast(count, words, true);
}

// Rays from points of the receiver, to points of the source or drawn by the cosine.
void VisibleShare::cast(int count, const std::uint32_t* words, bool by_cosine) {
  RTCRay16 rays;
  std::array<double, packet> weights;
  alignas(64) std::array<int, packet> valid{};
  const LaineKarras scramble;
  int active = 0;
  for (int k = 0; k < count; ++k) {
    const auto fraction = [&](int d) {
      const std::uint32_t word = bits_reversed(scramble(words[4 * k + d], seeds_[by_cosine][d]));
      return static_cast<float>(static_cast<int>(word >> 8)) * 0x1p-24f;
    };
    const RayPoint from = ends_.receiver.point(fraction(0), fraction(1));
    const RayPoint to = by_cosine ? met_by_cosine(from, fraction(2), fraction(3))
                                  : ends_.source.point(fraction(2), fraction(3));
    const RayPoint way = {to.x - from.x, to.y - from.y, to.z - from.z};
    weights[k] = weight(way);
    if (!(weights[k] > 0)) continue;
    if ((by_cosine || !ends_.source_is_part) && !ends_.on_source(Vec3(to.x, to.y, to.z))) continue;
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
  rtcOccluded16(valid.data(), scene_, &context, &rays);
  rays_ += active;
  for (int k = 0; k < count; ++k) {
    if (!valid[k]) continue;
    const bool hidden = rays.tfar[k] < 0;
    all_ += weights[k];
    squares_ += weights[k] * weights[k];
    if (!hidden) visible_ += weights[k];
    (hidden ? some_hidden_ : some_visible_) = true;
  }
}

// Where a ray meets the plane of the source; the point itself where it does not.
RayPoint VisibleShare::met_by_cosine(const RayPoint& from, float s, float t) const {
  const float angle = 2 * std::numbers::pi_v<float> * t, radius = std::sqrt(s), height = std::sqrt(1 - s);
  const float x = radius * std::cos(angle), y = radius * std::sin(angle);
  const RayPoint direction = {x * tangent_.x + y * bitangent_.x + height * normal_.x,
                              x * tangent_.y + y * bitangent_.y + height * normal_.y,
                              x * tangent_.z + y * bitangent_.z + height * normal_.z};
  const float towards = -dot(direction, source_normal_);
  if (!(towards > 0)) return from;
  const float distance = (dot(from, source_normal_) - source_offset_) / towards;
  return {from.x + distance * direction.x, from.y + distance * direction.y, from.z + distance * direction.z};
}

// What a pair of points would carry, over the density of such pairs among all that are drawn. 0 where either
// looks away.
double VisibleShare::weight(const RayPoint& way) const {
  const double cosine = dot(way, normal_), source_cosine = -dot(way, source_normal_), square = dot(way, way);
  if (!(cosine > 0 && source_cosine > 0)) return 0;
  const double kernel = cosine * source_cosine / (std::numbers::pi * square * square);
  return ends_.close ? kernel / (kernel + density_) : kernel;
}

}  // namespace luxel
