#pragma once

#include "luxel/gather_operator.h"
#include "transport/gather/gather_rays.h"

namespace luxel {

/// What of the planned rays, about, may go into finding how many are needed.
constexpr double sampling_share = 0.08;

/// Rays from each patch for the accuracy of the options, from how far two nets of other seeds differ on
/// packets drawn from all over the scene, at two numbers of rays.
/// @param radiosity  N x m, what the rays bring
/// @param whole      m: root mean square of the irradiance that the accuracy is relative to
/// @param planned    rays from each patch by the usual law
int rays_needed(const PatchMesh& mesh, const GatherRays& rays, const PatchField& radiosity,
                const Eigen::RowVectorXd& whole, bool fit, int planned, double accuracy);

}  // namespace luxel
