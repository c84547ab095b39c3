#pragma once

#include "luxel/operator_error.h"
#include "luxel/patch_mesh.h"
#include "luxel/plan.h"

namespace luxel {

/// Of the time that the rest of a run takes, about: what the error bar may take. A sixth of the whole, so
/// that it stays below a fifth where the rest is faster than foretold.
inline constexpr double error_bar_share = 0.2;

/// How the error bar of a run is found.
/// @param seconds  CPU time of the operator and the solver, from what was counted: no clock is read
OperatorErrorOptions error_bar_options(const PatchMesh& mesh, const PlanOptions& options, double seconds);

}  // namespace luxel
