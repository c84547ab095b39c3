#pragma once

#include <vector>

#include "form_factors/hidden_kernel.h"
#include "form_factors/polygon.h"

namespace luxel {

/// The two parts of a convex polygon on both sides of a plane.
struct Halves {
  Polygon front, behind;
};

/// Cuts the polygon. Either part has count 0 where the polygon reaches less than `tolerance` to that side;
/// the other is then the whole.
Halves halves(const Polygon& polygon, const Plane& plane, double tolerance);

/// Cuts cells of the outer patch where, seen from the outer patch, a corner of a shadow crosses an edge of
/// the inner polygon or of another shadow, or a corner of the inner polygon an edge of a shadow: between
/// these lines the hidden share is a smooth function of the point, but for the curves on which three edges of
/// different shadows meet. Cuts that take a sliver are left out.
/// Source: discontinuity meshing; Heckbert 1992, Lischinski, Tampieri and Greenberg 1992.
/// @param size       length of the outer patch
/// @param max_cells  no more cuts once there are so many cells
std::vector<Polygon> cut_by_events(const Polygon& cell, const Vec3& normal, const Polygon& inner,
                                   const Shadows& shadows, double size, std::size_t max_cells);

}  // namespace luxel
