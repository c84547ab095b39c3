#pragma once

#include <array>

#include "form_factors/polygon.h"

namespace luxel {

/// A point or a vector as rays take it.
struct RayPoint {
  float x, y, z;
};

RayPoint lowered(const Vec3& x);

/// The part of a flat polygon in front of a plane, and its points by numbers of the unit square. Only what
/// lies above each other's horizon can exchange light, and of a patch or a lamp that is mostly behind, points
/// of the whole would hardly meet it.
class FrontPart {
 public:
  /// @param outline  three or four corners
  /// @param parallelogram  four corners, of which the last is the first plus the third less the second
  FrontPart(const Polygon& outline, const Plane& plane, bool parallelogram);

  bool empty() const { return count_ == 0; }
  bool whole() const { return whole_; }
  double area() const { return area_; }

  /// Uniform for (s, t) uniform in the unit square.
  RayPoint point(float s, float t) const;

 private:
  static constexpr int most = 3;  // a quad cut by one plane
  struct Triangle {
    RayPoint corner, first, second;
  };
  void add(const Vec3& corner, const Vec3& first, const Vec3& second);

  int count_ = 0;
  bool whole_ = false, square_ = false;
  double area_ = 0;
  std::array<Triangle, most> triangles_;
  std::array<float, most> shares_;
};

}  // namespace luxel
