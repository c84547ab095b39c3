#include "form_factors/occluder_scene.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace luxel {

OccluderScene::OccluderScene(const OccluderSet& set) {
  device_ = rtcNewDevice(nullptr);
  if (!device_) throw std::runtime_error("Embree has no device");
  scene_ = rtcNewScene(device_);
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  std::vector<std::array<unsigned, 4>> quads;
  std::vector<Vec3> corners;
  for (const Occluder& occluder : set.occluders) {
    for (int f = occluder.begin; f < occluder.end; ++f) {
      const Polygon& outline = set.faces[f].outline;
      const auto base = static_cast<unsigned>(corners.size());
      for (int k = 0; k < outline.count; ++k) corners.push_back(outline[k]);
      for (unsigned k = 1; k + 1 < static_cast<unsigned>(outline.count); k += 2) {
        const unsigned last = std::min(k + 2, static_cast<unsigned>(outline.count) - 1);
        quads.push_back({base, base + k, base + k + 1, base + last});
      }
    }
  }
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_QUAD);
  auto* x = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), corners.size()));
  for (std::size_t k = 0; k < corners.size(); ++k) {
    for (int c = 0; c < 3; ++c) x[3 * k + static_cast<std::size_t>(c)] = static_cast<float>(corners[k][c]);
  }
  auto* index = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, 4 * sizeof(unsigned), quads.size()));
  for (std::size_t k = 0; k < quads.size(); ++k) std::copy(quads[k].begin(), quads[k].end(), index + 4 * k);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_);
}

OccluderScene::~OccluderScene() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

}  // namespace luxel
