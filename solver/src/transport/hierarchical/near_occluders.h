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

/// Whether a face that may stand between is so near to the end, within `radii` of its radii, that its shadow
/// changes across the end. Round bodies are near where their spheres are.
bool occluder_near(const OccluderSet& occluders, const HidingCandidates& candidates, const BlockEnd& end,
                   double radii);

}  // namespace luxel
