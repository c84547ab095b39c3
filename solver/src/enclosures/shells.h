#pragma once

#include <vector>

#include "enclosures/triangle_soup.h"

namespace luxel {

/// An edge that only one triangle has: light gets around it, from the front of the sheet to its back.
struct Rim {
  int triangle = 0;
  int from = 0, to = 0;  ///< vertices
};

/// Sides of triangles joined around their edges: what a walker on the surface can reach without passing
/// through it.
struct Shells {
  std::vector<int> shell;  ///< for each side (side_of), numbered from 0
  int count = 0;
  std::vector<Rim> rims;
};

/// Around each edge the triangles are sorted by angle; the two sides that look into one sector are joined.
/// Edges are matched by index, so that welded vertices are the caller's business.
Shells find_shells(const TriangleSoup& soup);

}  // namespace luxel
