#pragma once

#include <vector>

#include "luxel/plan.h"

namespace luxel {

/// One report of the systems that a plan solves one after the other, as if they were one.
class MergedReport {
 public:
  MergedReport(const PatchMesh& mesh, const PatchField& emission, const SolveOptions& options);

  void add(const SystemPlan& system, SolveReport report);

  const SolveReport& report() const { return report_; }
  /// With the residuals and the history put together; the object is spent.
  SolveReport take();

 private:
  /// Relative residual of the whole from those of the systems: each is its worst channel's, so that this is
  /// an upper bound, met where there is one system.
  double together(const std::vector<double>& residuals) const;

  const PatchMesh& mesh_;
  const PatchField& emission_;
  SolveReport report_;
  std::size_t largest_ = 0;                  ///< patches of the system whose method is named
  std::vector<Eigen::RowVectorXd> squares_;  ///< of each system: sum A E^2, each channel
  std::vector<double> residuals_;
  std::vector<std::vector<Iteration>> histories_;
};

}  // namespace luxel
