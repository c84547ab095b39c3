#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "luxel/operator_error.h"
#include "operator_error/defect.h"
#include "operator_error/interval.h"
#include "operator_error/probe.h"
#include "operator_error/strata.h"

namespace luxel {

/// Defects of a solution where one looks, and what they say of its error. All that it is given must outlive
/// it.
class Survey {
 public:
  /// @param parts  of the scene, between which errors are carried
  Survey(const PatchMesh& mesh, const RayScene& occluders, const PatchField& reflectance,
         const PatchField& emission, const RadiositySolution& solution, int parts);

  /// @param strata  a multiple of the parts
  /// @param rays    of each look, over the hemisphere
  std::vector<StratumDefects> defects(int strata, int rays, std::uint64_t seed,
                                      const Progress& progress) const;

  struct Finding {
    Interval interval;
    double noise_of_look = 0;  ///< mean square, relative to that of the irradiance
    double noise = 0;          ///< standard error of the mean square error from that noise alone
  };
  /// The error of the worst channel; all 0 where it is dark.
  Finding finding(const std::vector<StratumDefects>& defects) const;

 private:
  const PatchMesh& mesh_;
  const PatchField& reflectance_;
  const RadiositySolution& solution_;
  int parts_;
  Eigen::RowVectorXd whole_;      // mean square irradiance
  std::vector<double> measures_;  // by which patches are drawn
  Strata strata_;
  std::vector<std::int32_t> part_;
  Probe probe_;
};

}  // namespace luxel
