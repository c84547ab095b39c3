#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/LU>

#include "luxel/gather_operator.h"
#include "operator_error/defect.h"

namespace luxel {

/// Exchange between a few parts of the surface, from what rays met.
struct CoarseExchange {
  Eigen::MatrixXd form_factors;  ///< F_IJ
  std::vector<double> areas;     ///< of the parts, in one unit
  double reciprocity_error = 0;  ///< Frobenius norm of A_I F_IJ - A_J F_JI relative to that of A_I F_IJ
};

/// @param part   N: of each patch, 0 .. parts - 1
CoarseExchange coarse_exchange(const GatherOperator& transport, const std::vector<std::int32_t>& part,
                               int parts);

/// From what the rays of probes met.
CoarseExchange coarse_exchange(const std::vector<StratumDefects>& defects,
                               const std::vector<std::int32_t>& part, int parts);

}  // namespace luxel
