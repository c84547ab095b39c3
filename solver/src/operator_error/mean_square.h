#pragma once

#include <vector>

#include <Eigen/LU>

#include "luxel/patch_mesh.h"
#include "operator_error/coarse_exchange.h"
#include "operator_error/defect.h"

namespace luxel {

/// The mean square error over some strata, one channel, from the defects of all of them: their own, and what
/// the parts of the scene send on to one another.
class MeanSquare {
 public:
  /// Groups of strata that can be left out in turn.
  static constexpr int groups = 32;

  /// @param reflectance       of the channel: of patches
  /// @param mean_reflectance  and of parts
  MeanSquare(const std::vector<StratumDefects>& defects, const PatchField& reflectance,
             const CoarseExchange& coarse, const std::vector<double>& mean_reflectance, Eigen::Index channel);

  /// @param left_out  one of the groups, or -1
  double operator()(int left_out) const;

  /// The mean square noise of one look.
  double noise_of_look() const;

  /// The standard error of all strata together from the noise of the looks alone, as if there were no error.
  double noise() const;

 private:
  const std::vector<StratumDefects>& defects_;
  const PatchField& reflectance_;
  const CoarseExchange& coarse_;
  Eigen::Index channel_;
  Eigen::PartialPivLU<Eigen::MatrixXd> solver_;
};

}  // namespace luxel
