#pragma once

#include <vector>

#include "luxel/transport_operator.h"
#include "luxel/vector.h"
#include "transport/hierarchical/node_interpolation.h"
#include "transport/hierarchical/patch_hierarchy.h"

namespace luxel {

/// How bright each cluster is, as a multiple of the scene's RMS irradiance: what a block's error is weighed
/// by.
struct Brightness {
  std::vector<float> clusters;  ///< by number: area-weighted means
  std::vector<float> patches;   ///< by position in PatchHierarchy::order

  double operator()(const PatchHierarchy& hierarchy, int cluster) const {
    return hierarchy.single(cluster) ? patches[cluster - hierarchy.cluster_count()] : clusters[cluster];
  }
};

/// 1 everywhere.
Brightness uniform_brightness(const PatchHierarchy& hierarchy);

/// As if all that is emitted were spread evenly over the scene, but for the emitters themselves.
Brightness guessed_brightness(const PatchHierarchy& hierarchy, const PatchField& reflectance,
                              const PatchField& emission);

/// From a dozen bounces by a coarse operator; the brightest channel counts.
Brightness solved_brightness(const PatchHierarchy& hierarchy, const NodeInterpolation& interpolation,
                             const TransportOperator& coarse, const PatchField& reflectance,
                             const PatchField& emission);

}  // namespace luxel
