#pragma once

#include <vector>

#include "transport/gather/gather_rays.h"

namespace luxel {

/// F X by all rays of a gather.
struct GatheredField {
  PatchField values;             ///< N x m
  std::vector<double> row_sums;  ///< N: share of the rays that met a patch
  double smoothed = 0;           ///< mean share by which the packets followed their fit
};

/// F X with all rays: those stored, then the rest of the same nets, which are not.
/// @param kept  of the stored rays: those that belong to the nets, all or none
/// @param fit   smooth the noise between neighbours
/// @throws Cancelled
GatheredField final_gather(const PatchMesh& mesh, const GatherRays& rays, const GatherOperator& stored,
                           int kept, bool fit, const PatchField& x, const Progress& progress);

}  // namespace luxel
