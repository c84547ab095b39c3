#pragma once

#include "transport/hierarchical/block_end.h"

namespace luxel {

/// By how much the kernel, averaged over the other end, differs at the corners of a flat end from what is
/// interpolated between its nodes, at most: most where the other's horizon crosses the end, so that the nodes
/// may lie behind it and a corner before.
/// @param at_nodes  the kernel between the nodes, [4 a + b], a a node of `flat`
double corner_error(const BlockEnd& flat, const BlockEnd& other, const std::array<double, 16>& at_nodes);

}  // namespace luxel
