#pragma once

#include "form_factors/polygon.h"

namespace luxel {

/// Exchange area of two polygons wholly in front of each other's plane, nothing between, by the contour
/// double integral: the inner edges in closed form, the outer edges by Gauss on panels that are halved
/// towards the places where the inner contour comes near, until the rule's error bound (Bernstein ellipse)
/// holds. Right for touching, near and far pairs, up to rounding of 1e-16 (distance / size)^2 relative.
/// @param tolerance  wanted absolute error [square of the length unit]
double contour_exchange(const Polygon& a, const Polygon& b, double tolerance);

/// The same by point pairs, for polygons far apart.
/// @param order  Gauss points along each side, 1 .. 12
double point_exchange(const Polygon& a, const Vec3& normal_a, const Polygon& b, const Vec3& normal_b,
                      int order);

/// The same by Lambert's formula from Gauss points of a, for a that is small against its distance from b.
double lambert_exchange(const Polygon& a, const Vec3& normal_a, const Polygon& b, int order);

/// Smallest distance between two convex polygons.
double gap(const Polygon& a, const Plane& plane_a, const Polygon& b, const Plane& plane_b);

}  // namespace luxel
