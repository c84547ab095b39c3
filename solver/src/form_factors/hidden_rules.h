#pragma once

#include <cstddef>
#include <vector>

#include "form_factors/hidden_kernel.h"
#include "form_factors/polygon.h"

namespace luxel {

/// Quadrature points of a convex polygon with area weights: exact for polynomials of degree 1, 2 or 3, 4, 6
/// for order 1 to 4 (triangles: 1, 3, 6, 12 points; quads: order^2; others: cut into these). All points are
/// moved by 1e-9 of their cell, so that none lies on an axis of symmetry.
void add_points(const Polygon& cell, int order, OuterPoints& points);

/// Two rules on one cell, one after the other; their difference tells how far the integrand is from smooth.
struct RulePair {
  std::size_t first = 0, second = 0;  ///< points of each
  double trust = 0;                   ///< weight of the first in the value; the other's is what remains
};

/// Two rules of equal degree on a triangle (of three points each, degree 2) or a quad (four, degree 3).
RulePair add_equal_rules(const Polygon& triangle_or_quad, OuterPoints& points);

/// Those of order 3 and 2 of add_points(): the value is the first's, the difference bounds its error.
RulePair add_nested_rules(const Polygon& triangle_or_quad, OuterPoints& points);

/// Its corners, moved inwards by 1e-6 of the way to its middle, with weight 0.
void add_corners(const Polygon& cell, OuterPoints& points);

/// The triangles and quads of a fan around the first corner.
std::vector<Polygon> triangles_and_quads(const Polygon& cell);

}  // namespace luxel
