#pragma once

#include <memory>

#include "transport/gather/gather_rays.h"

namespace luxel {

/// The operator of the first `count` rays of each patch.
std::unique_ptr<GatherOperator> stored_rays(const GatherRays& rays, int count, const PatchMesh& mesh,
                                            const Progress& progress);

/// @throws std::invalid_argument unless they are of this mesh
void check_enclosures(const PatchMesh& mesh, const Enclosures& enclosures);

}  // namespace luxel
