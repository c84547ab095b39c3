#include "form_factors/near_kernels.h"

#include <Eigen/Geometry>
#include <numbers>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "form_factors/near_kernels.cpp"
// Highway compiles this file once per instruction set; the order of its headers matters.
// clang-format off
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <hwy/contrib/math/math-inl.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace luxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<double, 8>;
using Lanes = hn::Vec<Tag>;

struct Lanes3 {
  Lanes x, y, z;
};

HWY_INLINE Lanes3 minus(const Vec3& p, const Lanes3& x) {
  const Tag d;
  return {hn::Sub(hn::Set(d, p[0]), x.x), hn::Sub(hn::Set(d, p[1]), x.y), hn::Sub(hn::Set(d, p[2]), x.z)};
}

HWY_INLINE Lanes dot(const Lanes3& a, const Lanes3& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

HWY_INLINE Lanes dot(const Lanes3& a, const Vec3& b) {
  const Tag d;
  return dot(a, {hn::Set(d, b[0]), hn::Set(d, b[1]), hn::Set(d, b[2])});
}

HWY_INLINE Lanes3 cross(const Lanes3& a, const Lanes3& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}

// Angle of the point (x, y), y >= 0, in [0, pi].
HWY_INLINE Lanes angle(const Lanes y, const Lanes x) {
  const Tag d;
  const Lanes wide = hn::Abs(x);
  const Lanes low = hn::Min(wide, y), high = hn::Max(hn::Max(wide, y), hn::Set(d, 1e-300));
  Lanes t = hn::Atan(d, hn::Div(low, high));
  t = hn::IfThenElse(hn::Gt(y, wide), hn::Sub(hn::Set(d, 0.5 * std::numbers::pi), t), t);
  return hn::IfThenElse(hn::Lt(x, hn::Zero(d)), hn::Sub(hn::Set(d, std::numbers::pi), t), t);
}

// Fills the last vector with copies of the first point of weight 0.
void pad(PointBatch& points) {
  const int lanes = static_cast<int>(hn::Lanes(Tag()));
  for (int k = points.count; k % lanes != 0; ++k) {
    points.x[k] = points.x[0], points.y[k] = points.y[0], points.z[k] = points.z[0];
    points.wx[k] = points.wy[k] = points.wz[k] = 0;
  }
}

HWY_INLINE Lanes3 positions(const PointBatch& points, int k) {
  const Tag d;
  return {hn::Load(d, points.x + k), hn::Load(d, points.y + k), hn::Load(d, points.z + k)};
}

HWY_INLINE Lanes3 weights(const PointBatch& points, int k) {
  const Tag d;
  return {hn::Load(d, points.wx + k), hn::Load(d, points.wy + k), hn::Load(d, points.wz + k)};
}

double LogContour(PointBatch& points, const Polygon& polygon) {
  const Tag d;
  pad(points);
  const int m = polygon.count;
  Vec3 tangent[Polygon::capacity];
  double length[Polygon::capacity];
  for (int e = 0; e < m; ++e) {
    tangent[e] = polygon.next(e) - polygon[e];
    length[e] = tangent[e].norm();
    if (length[e] > 0) tangent[e] /= length[e];
  }
  Lanes sum = hn::Zero(d);
  for (int k = 0; k < points.count; k += static_cast<int>(hn::Lanes(d))) {
    const Lanes3 x = positions(points, k), w = weights(points, k);
    Lanes3 here = minus(polygon[0], x);
    const Lanes tiny = hn::Set(d, 1e-300), half = hn::Set(d, 0.5);
    const Lanes3 first = here;
    Lanes log_here = hn::Mul(half, hn::Log(d, hn::Max(dot(here, here), tiny)));
    const Lanes log_first = log_here;
    for (int e = 0; e < m; ++e) {
      const bool last = e + 1 == m;
      const Lanes3 there = last ? first : minus(polygon[e + 1], x);
      const Lanes log_there = last ? log_first : hn::Mul(half, hn::Log(d, hn::Max(dot(there, there), tiny)));
      const Vec3& t = tangent[e];
      const Lanes3 u{hn::Set(d, t[0]), hn::Set(d, t[1]), hn::Set(d, t[2])};
      const Lanes3 across = cross(here, u);
      const Lanes height = hn::Sqrt(dot(across, across));
      const Lanes subtended = angle(hn::Mul(height, hn::Set(d, length[e])), dot(here, there));
      Lanes integral = hn::Mul(dot(there, u), log_there);
      integral = hn::NegMulAdd(dot(here, u), log_here, integral);
      integral = hn::MulAdd(height, subtended, integral);
      sum = hn::MulAdd(integral, dot(w, u), sum);
      here = there;
      log_here = log_there;
    }
  }
  return hn::GetLane(hn::SumOfLanes(d, sum));
}

double LambertSum(PointBatch& points, const Polygon& polygon) {
  const Tag d;
  pad(points);
  Lanes sum = hn::Zero(d);
  for (int k = 0; k < points.count; k += static_cast<int>(hn::Lanes(d))) {
    const Lanes3 x = positions(points, k), w = weights(points, k);
    Lanes3 here = minus(polygon[0], x);
    const Lanes3 first = here;
    for (int e = 0; e < polygon.count; ++e) {
      const Lanes3 there = e + 1 == polygon.count ? first : minus(polygon[e + 1], x);
      // there x here, because the polygon faces the point and so runs clockwise in its view
      const Lanes3 normal = cross(there, here);
      const Lanes length = hn::Sqrt(hn::Max(dot(normal, normal), hn::Set(d, 1e-300)));
      const Lanes subtended = angle(length, dot(here, there));
      sum = hn::MulAdd(hn::Div(subtended, length), dot(w, normal), sum);
      here = there;
    }
  }
  return hn::GetLane(hn::SumOfLanes(d, sum)) / (2 * std::numbers::pi);
}

double PointPairSum(const PointBatch& a, PointBatch& b) {
  const Tag d;
  pad(b);
  Lanes sum = hn::Zero(d);
  for (int k = 0; k < b.count; k += static_cast<int>(hn::Lanes(d))) {
    const Lanes3 y = positions(b, k), wy = weights(b, k);
    for (int i = 0; i < a.count; ++i) {
      const Lanes3 away = minus(Vec3(a.x[i], a.y[i], a.z[i]), y);  // x - y
      const Lanes cosines = hn::Mul(dot(wy, away), dot(away, Vec3(a.wx[i], a.wy[i], a.wz[i])));
      const Lanes square = dot(away, away);
      sum = hn::Sub(sum, hn::Div(cosines, hn::Mul(square, square)));
    }
  }
  return hn::GetLane(hn::SumOfLanes(d, sum)) / std::numbers::pi;
}

}  // namespace
}  // namespace luxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace luxel {

HWY_EXPORT(LogContour);
HWY_EXPORT(LambertSum);
HWY_EXPORT(PointPairSum);

double log_contour(PointBatch& points, const Polygon& polygon) {
  return HWY_DYNAMIC_DISPATCH(LogContour)(points, polygon);
}

double lambert_sum(PointBatch& points, const Polygon& polygon) {
  return HWY_DYNAMIC_DISPATCH(LambertSum)(points, polygon);
}

double point_pair_sum(const PointBatch& a, PointBatch& b) {
  return HWY_DYNAMIC_DISPATCH(PointPairSum)(a, b);
}

}  // namespace luxel
#endif
