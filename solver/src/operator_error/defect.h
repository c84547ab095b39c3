#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace luxel {

/// What was found at one probe, m columns.
struct Defect {
  int patch = 0;
  double weight = 1;                         ///< of its stratum's area, over that of the probes of all
  std::array<Eigen::RowVectorXd, 2> halves;  ///< H - F B by two looks [W/m2]
  std::vector<int> met;                      ///< rays of both that met each part
  double row_sum = 0;
  int looked = 0;         ///< rays of both over the hemisphere
  std::int64_t rays = 0;  ///< all that were cast

  Eigen::RowVectorXd mean() const { return (halves[0] + halves[1]) / 2; }
};

/// Patches drawn from each stratum: errors seen on two of them are carried to the third, so that no noise is
/// multiplied by itself.
constexpr int batches = 3;
using StratumDefects = std::array<Defect, batches>;

}  // namespace luxel
