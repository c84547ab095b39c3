#pragma once

#include <memory>

#include "luxel/hierarchical_operator.h"
#include "transport/hierarchical/coarse_operator.h"
#include "transport/hierarchical/node_interpolation.h"

namespace luxel {

struct HierarchicalOperator::Impl {
  Impl(NodeInterpolation between, CoarseOperator nodes)
      : interpolation(std::move(between)), coarse(std::move(nodes)) {}

  NodeInterpolation interpolation;
  CoarseOperator coarse;
  std::vector<double> row_sums;  ///< of the patches
  HierarchicalReport report;
};

}  // namespace luxel
