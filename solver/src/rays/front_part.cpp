#include "rays/front_part.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace luxel {

RayPoint lowered(const Vec3& x) {
  return {static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2])};
}

FrontPart::FrontPart(const Polygon& outline, const Plane& plane, bool parallelogram) {
  whole_ = span_along(outline, plane).low >= 0;
  const Polygon part = whole_ ? outline : clip(outline, plane, 0);
  std::array<double, most> areas{};
  for (int k = 0; k + 2 < part.count; ++k) {
    areas[k] = (part[k + 1] - part[0]).cross(part[k + 2] - part[0]).norm() / 2;
    area_ += areas[k];
  }
  if (!(area_ > 0)) return;
  square_ = whole_ && parallelogram;
  if (square_) {
    add(part[0], part[1], part[3]);
    return;
  }
  for (int k = 0; k + 2 < part.count; ++k) {
    shares_[k] = static_cast<float>(areas[k] / area_);
    add(part[0], part[k + 1], part[k + 2]);
  }
}

void FrontPart::add(const Vec3& corner, const Vec3& first, const Vec3& second) {
  triangles_[count_++] = {lowered(corner), lowered(first - corner), lowered(second - corner)};
}

RayPoint FrontPart::point(float s, float t) const {
  int k = 0;
  if (!square_) {
    for (; k + 1 < count_ && s >= shares_[k]; ++k) s -= shares_[k];
    s = shares_[k] > 0 ? std::min(s / shares_[k], 1.0F) : 0;
    // the square folded onto a triangle, which keeps neighbours together (Heitz 2019)
    const float half_s = s / 2, half_t = t / 2;
    const bool above = t > s;
    s = above ? half_s : s - half_t;
    t = above ? t - half_s : half_t;
  }
  const auto& [corner, first, second] = triangles_[k];
  return {corner.x + s * first.x + t * second.x, corner.y + s * first.y + t * second.y,
          corner.z + s * first.z + t * second.z};
}

}  // namespace luxel
