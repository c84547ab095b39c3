#pragma once

#include "triangulate.h"

namespace luxel {

/// Points that are to be added to a domain.
struct AddedPoints {
  /// Parts of borders and creases to be halved, one after the other: the k-th by the point number
  /// points.size() + k of the domain, which later ones may name.
  std::vector<std::array<int, 2>> halved;
  std::vector<Vec2> inside;
};

/// What must be added so that the domain's triangles have no angle below `smallest` [radians], but for
/// corners of the domain that are sharper and for what may not be halved: `least` is for each border, then
/// for each crease, the length that its halves must keep, in points' units; infinity: it stays whole. At most
/// about `most` points, though: then angles stay sharper. Nothing without CGAL. Cost: n log n, and the bad
/// triangles times the edges. Source: J. Ruppert, A Delaunay refinement algorithm, 1995; A. Uengoer,
/// Off-centers, 2004.
AddedPoints widen_angles(const PlanarDomain& domain, const std::vector<double>& least, double smallest,
                         std::size_t most);

/// The same with CGAL's constrained Delaunay triangulation. Only there if LUXEL_WITH_CGAL is defined.
AddedPoints widen_delaunay_angles(const PlanarDomain& domain, const std::vector<double>& least,
                                  double smallest, std::size_t most);

}  // namespace luxel
