#pragma once

#include <span>

#include "luxel/operator_error.h"
#include "transport/gather/gather_rays.h"

namespace luxel {

/// operator_error() with rays and some that are stored at hand: a gather's own.
OperatorError probed_error(const PatchMesh& mesh, const RayScene& occluders, const GatherRays& rays,
                           const GatherOperator& stored, const PatchField& reflectance,
                           const PatchField& emission, const RadiositySolution& solution,
                           std::span<const double> row_sums, const OperatorErrorOptions& options,
                           const Progress& progress);

}  // namespace luxel
