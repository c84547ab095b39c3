#pragma once

#include "form_factors/occluder_set.h"

struct RTCDeviceTy;
struct RTCSceneTy;

namespace luxel {

/// The faces of an occluder set in Embree, in their working coordinates: for rays that ask whether anything
/// is hidden. Safe from many threads.
class OccluderScene {
 public:
  explicit OccluderScene(const OccluderSet& set);
  ~OccluderScene();
  OccluderScene(const OccluderScene&) = delete;
  OccluderScene& operator=(const OccluderScene&) = delete;

  RTCSceneTy* scene() const { return scene_; }

 private:
  RTCDeviceTy* device_ = nullptr;
  RTCSceneTy* scene_ = nullptr;
};

}  // namespace luxel
