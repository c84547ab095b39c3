#include "point_factors/seen_pieces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace luxel {

namespace {

// A sheet that lies closer behind another than this share of the diagonal lies in it: above the rounding of
// coordinates, below every gap that counts (1e-6).
constexpr double same_sheet = 1e-10;

/// The part of a convex polygon where distance > 0, given at its corners.
template <class Distance>
ConvexPiece clipped(const ConvexPiece& polygon, const Distance& distance) {
  ConvexPiece result;
  const std::size_t count = polygon.size();
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3& a = polygon[k];
    const Vec3& b = polygon[(k + 1) % count];
    const double da = distance(a), db = distance(b);
    if (da > 0) result.push_back(a);
    if ((da > 0) != (db > 0) && da != db) result.push_back(a + da / (da - db) * (b - a));
  }
  if (result.size() < 3) result.clear();
  return result;
}

}  // namespace

PointView::PointView(const Occluders& occluders, const Vec3& point, const Vec3& normal) : point_(point) {
  Vec3 low = point, high = point;
  double largest = point.cwiseAbs().maxCoeff();
  for (const Vec3& x : occluders.vertices) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
    largest = std::max(largest, x.cwiseAbs().maxCoeff());
  }
  tolerance_ =
      std::max(same_sheet * (high - low).norm(), 8 * std::numeric_limits<double>::epsilon() * largest);
  for (const auto& triangle : occluders.triangles) {
    std::array<Vec3, 3> corner;
    for (int k = 0; k < 3; ++k) corner[k] = occluders.vertices[triangle[k]];
    const bool above = std::any_of(corner.begin(), corner.end(),
                                   [&](const Vec3& x) { return normal.dot(x - point) > tolerance_; });
    Vec3 away = (corner[1] - corner[0]).cross(corner[2] - corner[0]).stableNormalized();
    const double depth = away.dot(corner[0] - point);
    // seen edge-on, or from within its plane, a triangle hides nothing
    if (!above || std::abs(depth) <= tolerance_) continue;
    if (depth < 0) {
      away = -away;
      std::swap(corner[1], corner[2]);
    }
    Shadow shadow;
    shadow.plane = away;
    shadow.corner = corner[0];
    for (int k = 0; k < 3; ++k) {
      shadow.sides[k] = (corner[k] - point).cross(corner[(k + 1) % 3] - point).stableNormalized();
    }
    shadows_.push_back(shadow);
  }
}

std::vector<ConvexPiece> PointView::seen_pieces(const ConvexPiece& polygon) const {
  std::vector<ConvexPiece> pieces{polygon}, next;
  for (const Shadow& shadow : shadows_) {
    const auto behind = [&](const Vec3& x) { return shadow.plane.dot(x - shadow.corner) - tolerance_; };
    const auto inside = [&](int k) {
      return [&, k](const Vec3& x) { return shadow.sides[k].dot(x - point_); };
    };
    const auto misses = [&](const ConvexPiece& piece) {
      const auto all_out = [&](const auto& distance) {
        return std::all_of(piece.begin(), piece.end(), [&](const Vec3& x) { return distance(x) <= 0; });
      };
      return all_out(behind) || all_out(inside(0)) || all_out(inside(1)) || all_out(inside(2));
    };
    next.clear();
    for (ConvexPiece& piece : pieces) {
      if (misses(piece)) {
        next.push_back(std::move(piece));
        continue;
      }
      // peel off what lies outside of one plane after the other; what is left is hidden
      const auto peel = [&](const auto& distance) {
        ConvexPiece outside = clipped(piece, [&](const Vec3& x) { return -distance(x); });
        if (!outside.empty()) next.push_back(std::move(outside));
        piece = clipped(piece, distance);
      };
      for (int k = 0; k < 3 && !piece.empty(); ++k) peel(inside(k));
      if (!piece.empty()) peel(behind);
    }
    std::swap(pieces, next);
    if (pieces.empty()) break;
  }
  return pieces;
}

}  // namespace luxel
