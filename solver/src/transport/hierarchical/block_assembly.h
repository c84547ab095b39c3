#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "form_factors/occluder_scene.h"
#include "form_factors/occluder_set.h"
#include "luxel/progress.h"
#include "transport/hierarchical/block_list.h"
#include "transport/hierarchical/brightness.h"
#include "transport/hierarchical/patch_hierarchy.h"

namespace luxel {

/// Everything that decides where blocks end.
struct AssemblyOptions {
  double accuracy = 1e-2;     ///< of the irradiance, as a share of the scene's RMS irradiance
  double block_error = 1e-3;  ///< most that a block may err by, likewise
  std::uint64_t seed = 0;
};

/// What can hide light: the occluders of a scene and rays against them.
struct HidingScene {
  OccluderSet occluders;
  std::unique_ptr<OccluderScene> rays;  ///< null where there are none
};

/// All blocks between patches that may see each other, in a fixed order of tasks: the same for any number of
/// threads. A pair of clusters is divided while its error, estimated from the kernel's variation and from
/// what rays find, times the brightness of either end exceeds block_error.
/// @throws Cancelled
std::vector<BlockList> assemble_blocks(const PatchHierarchy& hierarchy, const HidingScene& scene,
                                       const Brightness& brightness, const AssemblyOptions& options,
                                       const Progress& progress);

}  // namespace luxel
