#pragma once

#include <embree3/rtcore.h>

#include <array>
#include <cstddef>

#include "form_factors/occluder_set.h"
#include "form_factors/sight_lines.h"

namespace luxel {

/// The occluders' faces for Embree. Safe from many threads.
class OccluderScene {
 public:
  explicit OccluderScene(const OccluderSet& set);
  ~OccluderScene();
  OccluderScene(const OccluderScene&) = delete;
  OccluderScene& operator=(const OccluderScene&) = delete;

  RTCScene scene() const { return scene_; }

 private:
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
};

/// Gathers lines of sight and traces them sixteen at a time. `OnLine(owner, weight,
/// arrives)` is told of each, in order.
template <class OnLine>
class SightPacket {
 public:
  SightPacket(const OccluderScene& scene, OnLine on_line) : scene_(scene.scene()), on_line_(on_line) {
    rtcInitIntersectContext(&context_);
    context_.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  }

  void add(std::size_t owner, const SightLine& line) {
    const Vec3 &from = line.from, along = line.to - line.from;
    rays_.org_x[count_] = static_cast<float>(from.x());
    rays_.org_y[count_] = static_cast<float>(from.y());
    rays_.org_z[count_] = static_cast<float>(from.z());
    rays_.dir_x[count_] = static_cast<float>(along.x());
    rays_.dir_y[count_] = static_cast<float>(along.y());
    rays_.dir_z[count_] = static_cast<float>(along.z());
    rays_.tnear[count_] = 0;
    rays_.tfar[count_] = 1;
    rays_.time[count_] = 0;
    rays_.mask[count_] = ~0u;
    rays_.id[count_] = static_cast<unsigned>(count_);
    rays_.flags[count_] = 0;
    owner_[count_] = owner;
    weight_[count_] = line.weight;
    if (++count_ == packet) trace();
  }

  void trace() {
    if (count_ == 0) return;
    alignas(64) std::array<int, packet> valid{};
    for (int k = 0; k < count_; ++k) valid[k] = -1;
    rtcOccluded16(valid.data(), scene_, &context_, &rays_);
    for (int k = 0; k < count_; ++k) on_line_(owner_[k], weight_[k], !(rays_.tfar[k] < 0));
    count_ = 0;
  }

 private:
  static constexpr int packet = 16;

  RTCScene scene_;
  OnLine on_line_;
  RTCIntersectContext context_;
  alignas(64) RTCRay16 rays_;
  std::array<std::size_t, packet> owner_;
  std::array<double, packet> weight_;
  int count_ = 0;
};

}  // namespace luxel
