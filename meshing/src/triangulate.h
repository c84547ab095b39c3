#pragma once

#include <array>
#include <optional>
#include <vector>

#include "polygon.h"

namespace luxel {

/// A part of the plane: points, the border that separates inside from outside, and edges inside that the
/// triangles must keep.
struct PlanarDomain {
  std::vector<Vec2> points;
  std::vector<std::array<int, 2>> borders;  ///< closed loops in any order, the inside on the left
  std::vector<std::array<int, 2>> creases;
};

/// Triangles, counter-clockwise, that cover the inside and use every point in or on it; nothing if borders or
/// creases cross. Constrained Delaunay where the build has CGAL (n log n), else by ears (quadratic), which
/// takes borders only: no creases, no points inside.
std::optional<std::vector<std::array<int, 3>>> triangulate(const PlanarDomain& domain);

/// Constrained Delaunay triangulation: CGAL's. Only there if LUXEL_WITH_CGAL is defined.
std::optional<std::vector<std::array<int, 3>>> triangulate_delaunay(const PlanarDomain& domain);

/// Ear clipping, holes joined to the outer loop by bridges; points inside and creases are not used.
/// Source: D. Eberly, Triangulation by ear clipping, 2002.
std::optional<std::vector<std::array<int, 3>>> triangulate_by_ears(const PlanarDomain& domain);

}  // namespace luxel
