#pragma once

#include <limits>
#include <vector>

#include "form_factors/occluder_set.h"
#include "form_factors/shaft.h"
#include "transport/hierarchical/block_end.h"

namespace luxel {

/// What may stand between two ends, found when their radii summed up to `reach`.
struct HidingCandidates {
  std::vector<Candidate> list;
  double reach = std::numeric_limits<double>::infinity();

  bool empty() const { return list.empty(); }
};

/// Whether a face that may stand between is so near to the end, within `radii` of its radii from the middle,
/// that its shadow changes across the end. Round bodies are near where their spheres are.
bool occluder_near(const OccluderSet& occluders, const HidingCandidates& candidates, const BlockEnd& end,
                   double radii);

/// Whether a corner of a face that may stand between is on a flat end's rectangle, or within `radii` of its
/// radii from that: a leg that stands on a floor hides half of all directions from the points beside it,
/// however thin it is.
bool occluder_stands_on(const OccluderSet& occluders, const HidingCandidates& candidates, const BlockEnd& end,
                        double radii);

}  // namespace luxel
