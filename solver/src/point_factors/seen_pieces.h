#pragma once

#include <vector>

#include "luxel/patch_mesh.h"
#include "luxel/vector.h"

namespace luxel {

/// A flat convex polygon of any number of corners, counter-clockwise seen from its front.
using ConvexPiece = std::vector<Vec3>;

/// Cuts what triangles hide, seen from one point, away from polygons.
class PointView {
 public:
  /// The triangles of the occluders that stand in front of the point's horizon plane, at least in part.
  PointView(const Occluders& occluders, const Vec3& point, const Vec3& normal);

  int occluder_count() const { return static_cast<int>(shadows_.size()); }

  /// The parts of the polygon that are seen from the point: convex and disjoint, exact up to rounding.
  std::vector<ConvexPiece> seen_pieces(const ConvexPiece& polygon) const;

 private:
  /// What a triangle hides: the points behind its plane and inside its three side planes, which go through
  /// the point. A point x is hidden where sides[k] . (x - point) > 0 for all k, and plane . (x - corner) > 0.
  struct Shadow {
    Vec3 sides[3];
    Vec3 plane;
    Vec3 corner;
  };

  Vec3 point_;
  double tolerance_ = 0;  // [m]: what lies closer behind a triangle than this lies in it
  std::vector<Shadow> shadows_;
};

}  // namespace luxel
