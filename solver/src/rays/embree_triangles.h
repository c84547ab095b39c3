#pragma once

#include <array>
#include <span>
#include <vector>

#include "luxel/ray_scene.h"
#include "luxel/vector.h"

struct RTCDeviceTy;
struct RTCSceneTy;

namespace luxel {

/// Triangles in Embree, in working coordinates: centred, and scaled by a power of two so that the diagonal
/// lies in [1, 2). Embree proposes hits in float; side and distance come from the triangle's plane in double.
class EmbreeTriangles {
 public:
  using Hit = RayScene::Hit;

  /// How many rays trace() takes at once.
  static constexpr int packet_size = 16;

  /// @param with_twins  some triangles may lie back to back in one place: facing_twin() will be asked
  EmbreeTriangles(const std::vector<Vec3>& vertices, const std::vector<std::array<int, 3>>& triangles,
                  bool with_twins);
  ~EmbreeTriangles();
  EmbreeTriangles(const EmbreeTriangles&) = delete;
  EmbreeTriangles& operator=(const EmbreeTriangles&) = delete;

  /// Nearest hits of 1 to packet_size rays. They run from `starts`, but count from `origins`, which lie on
  /// surfaces with these normals: a hit on the origin's own surface, or behind the origin, is refuted and the
  /// ray goes on from there. Distances are in working units.
  void trace(std::span<const Vec3> origins, std::span<const Vec3> starts, std::span<const Vec3> normals,
             std::span<const Vec3> directions, std::span<Hit> hits) const;

  /// Where two sheets lie back to back Embree may report either: the front in the place of a `back` that was
  /// met, or else that back.
  Hit facing_twin(const Vec3& origin, const Vec3& normal, const Vec3& direction, const Hit& back) const;

  Vec3 working(const Vec3& x) const { return (x - centre_) * scale_; }
  const Vec3& centre() const { return centre_; }
  double scale() const { return scale_; }
  /// How far off their surface rays start, in working units.
  double offset() const { return offset_; }
  RTCSceneTy* scene() const { return scene_; }

 private:
  struct Plane {
    Vec3 normal;  // unit, front
    double offset;
  };
  struct FrontsOnly;

  void find_frame(const std::vector<Vec3>& vertices);

  RTCDeviceTy* device_ = nullptr;
  RTCSceneTy* scene_ = nullptr;
  Vec3 centre_ = Vec3::Zero();
  double scale_ = 1;
  double offset_ = 0;    // working units
  double rounding_ = 0;  // of the input's coordinates, working units
  std::vector<Plane> planes_;
};

}  // namespace luxel
