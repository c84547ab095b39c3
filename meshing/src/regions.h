#pragma once

#include <functional>

#include "edge_table.h"
#include "facets.h"

namespace luxel {

/// Connected facets that lie in one plane.
struct Regions {
  std::vector<int> region_of_facet;
  std::vector<int> offsets{0};     ///< region r has the facets members[offsets[r] .. offsets[r + 1])
  std::vector<int> members;        ///< the seed first
  std::vector<double> tolerances;  ///< for each region how far a corner may be off the seed's plane [m]

  int size() const { return static_cast<int>(offsets.size()) - 1; }
  std::span<const int> operator[](int r) const {
    return std::span(members).subspan(offsets[r], offsets[r + 1] - offsets[r]);
  }
};

/// Grows regions across shared edges, the largest facets first. A facet joins if its normal agrees and all
/// its corners lie in the plane of the seed (not of its neighbour: a finely cut sphere must not become flat),
/// and if may_join(member, facet) allows it. `areas` are the facets' area vectors. Cost: n log n.
Regions grow_regions(const Facets& facets, const std::vector<Vec3>& areas, const EdgeTable& edges,
                     const std::function<bool(int, int)>& may_join);

}  // namespace luxel
