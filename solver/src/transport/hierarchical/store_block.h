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
void store_block(const BlockEnd& r, const BlockEnd& s, const BlockKernel& kernel, const RayCount& rays,
                 const BlockTolerance& tolerance, BlockList& list);

/// The same for single patches too near, or too steep, for the kernel between nodes: it is integrated
/// exactly.
/// @param visible  share of it that nothing hides
void store_near_block(const BlockEnd& r, const BlockEnd& s, double visible, const BlockTolerance& tolerance,
                      BlockList& list);

}  // namespace luxel
