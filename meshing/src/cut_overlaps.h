#pragma once

#include <optional>
#include <vector>

#include "facets.h"
#include "overlapping_polygons.h"
#include "regions.h"

namespace luxel {

/// Facets of which no two radiate from the same place of one plane to the same side.
struct CutFacets {
  Facets facets;         ///< each face's facets still follow each other, in the faces' order
  double area = 0;       ///< that was cut away, each side for itself [m2]
  int faces = 0;         ///< that lost some or all of their area
  int first_face = -1;   ///< the first of them
  int first_above = -1;  ///< and the first face that covers a part of it
};

/// Takes from each facet what facets of earlier faces (or earlier facets of its own face) cover on the same
/// side: the rest as convex pieces, with a vertex for each corner that is new. A part of a two-sided face
/// whose other side is free keeps that one. `regions` are the facets' coplanar regions, `overlaps` those that
/// lie over each other. Nothing if no facet loses anything. Cost: linear in the facets, n log n in those of
/// overlapping regions.
std::optional<CutFacets> cut_overlaps(const Facets& facets, const Regions& regions,
                                      const std::vector<OverlappingPair>& overlaps);

}  // namespace luxel
