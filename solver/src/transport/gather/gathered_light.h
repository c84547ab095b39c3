#pragma once

#include <functional>
#include <memory>

#include "luxel/gather_operator.h"
#include "transport/gather/gather_rays.h"

namespace luxel {

/// What solve_gathered() gives, with what it worked with, for those who go on from there.
struct GatheredLight {
  GatheredSolution solution;
  std::unique_ptr<GatherRays> rays;
  std::unique_ptr<GatherOperator> stored;  ///< of the rays that were iterated on
};

enum class GatherStage { rays, iteration };

/// solve_gathered(); tells at the start of each stage, which come in turn. The mesh and the ray scene must
/// outlive the result.
GatheredLight gather_light(const PatchMesh& mesh, const RayScene& occluders, const PatchField& reflectance,
                           const PatchField& emission, const GatherOptions& options,
                           const SolveOptions& solving, const Progress& progress,
                           const std::function<void(GatherStage)>& on_stage = {});

}  // namespace luxel
