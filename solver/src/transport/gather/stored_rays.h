#pragma once

#include <memory>

#include "transport/gather/gather_rays.h"

namespace luxel {

/// The operator of the first `count` rays of each patch.
std::unique_ptr<GatherOperator> stored_rays(const GatherRays& rays, int count, const PatchMesh& mesh,
                                            const Progress& progress);

}  // namespace luxel
