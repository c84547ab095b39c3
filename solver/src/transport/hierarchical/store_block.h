#pragma once

#include "transport/hierarchical/block_end.h"
#include "transport/hierarchical/block_list.h"
#include "transport/hierarchical/block_rays.h"

namespace luxel {

/// What a block may err by, as a share of the scene's RMS irradiance, and how bright its ends are.
struct BlockTolerance {
  double error = 0;
  double bright_r = 1, bright_s = 1;
};

/// Adds the kernel, with what rays left of it, to the list, as simply as the tolerance admits. A single patch
/// has one value.
/// @param near  both ends are single patches too near, or too steep, for the kernel between nodes: it is
/// integrated exactly
void store_block(const BlockEnd& r, const BlockEnd& s, const BlockKernel& kernel, const RayCount& rays,
                 bool near, const BlockTolerance& tolerance, BlockList& list);

}  // namespace luxel
