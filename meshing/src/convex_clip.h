#pragma once

#include <span>
#include <vector>

#include "polygon.h"

namespace luxel {

/// A corner of a piece that clipping makes: a place in the plane, the point in space, and which vertex it is.
struct ClipCorner {
  Vec2 flat;        ///< [m]
  Vec3 point;       ///< [m]
  int vertex = -1;  ///< of the mesh; -1: made by clipping
};

/// A convex polygon, counter-clockwise.
using ConvexPiece = std::vector<ClipCorner>;

/// What a convex polygon leaves of another: the pieces outside of it and the one inside.
struct Subtraction {
  std::vector<ConvexPiece> outside;
  ConvexPiece inside;  ///< empty: the two do not overlap, and `outside` is the piece as it was
};

/// Cuts `piece` along the edges of `cutter` (convex, counter-clockwise). What lies within `tolerance` [m] of
/// an edge is on it; pieces no wider than that are dropped, and overlap no wider is none.
Subtraction subtract(const ConvexPiece& piece, std::span<const Vec2> cutter, double tolerance);

/// Area [m2].
double flat_area(const ConvexPiece& piece);

}  // namespace luxel
