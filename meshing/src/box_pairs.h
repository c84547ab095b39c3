#pragma once

#include <span>
#include <utility>
#include <vector>

#include "box_tree.h"

namespace luxel {

/// The pairs of boxes that touch, each once, the lower index first. Cost: linear for boxes of much the same
/// size along a line or over a plane, n log n otherwise, and what it finds.
std::vector<std::pair<int, int>> touching_pairs(const std::vector<Box>& boxes);

}  // namespace luxel
