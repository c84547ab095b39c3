#pragma once

#include <Eigen/Geometry>
#include <array>
#include <span>
#include <vector>

#include "luxel/vector.h"

namespace luxel {

using Vec2 = Eigen::Vector2d;

/// Area times unit normal [m2] of a closed loop of points (Newell); differences to the first point are taken
/// first, so that an offset from the origin costs no digits.
Vec3 area_vector(std::span<const Vec3> loop);

/// Area centroid [m] of a flat loop with area vector `area`.
Vec3 area_centroid(std::span<const Vec3> loop, const Vec3& area);

/// Length of the longest edge [m].
double longest_edge(std::span<const Vec3> loop);

/// What the rounding of the coordinates alone can move a point by [m].
double rounding(std::span<const Vec3> points);

/// Whether the loop is more than a line: its height above its longest edge exceeds rounding.
bool has_area(std::span<const Vec3> loop);

/// Whether no corner is further from the plane through the corners' mean than 1e-6 of the longest edge.
bool is_flat(std::span<const Vec3> loop);

/// Whether every corner of a flat loop turns left, seen from the side that its area vector points to; a
/// straight corner does not count as a turn.
bool is_convex(std::span<const Vec3> loop);

/// Two unit vectors that span the plane normal to the unit vector n: (u, v, n) is right-handed.
std::array<Vec3, 2> plane_axes(const Vec3& n);

}  // namespace luxel
