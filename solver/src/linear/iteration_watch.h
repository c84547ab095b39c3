#pragma once

#include <string>

#include "linear/error_bound.h"
#include "luxel/solve.h"

namespace luxel {

/// Decides after every iteration whether to go on, and writes the history, the reason and its likely cause to
/// the report. Every method reports to one.
class IterationWatch {
 public:
  /// @param bound  null: no error bounds are wanted, and options.error is not looked at
  IterationWatch(const RadiositySystem& system, const SolveOptions& options, const ErrorBound* bound,
                 SolveReport& report);

  /// Before the first iteration, and again when a method starts anew from where it stood. Both functions
  /// return whether to go on.
  bool start(const PatchField& residual, const PatchField& radiosity);
  /// After one more iteration, with E - B + K B.
  bool next(const PatchField& residual, const PatchField& radiosity);
  /// After one more iteration of a method that has only the relative residual norms at hand.
  bool next(const Eigen::RowVectorXd& relative_norms);

  /// Ends the iteration for a reason of the method's own; returns false.
  bool stop(Stopped reason, std::string message);

  /// Asks half the residual of the iterations to come, after one from a recurrence has promised too much.
  void tighten() { margin_ *= 0.5; }
  /// Whether this residual and radiosity satisfy the stopping rule itself.
  bool satisfied(const PatchField& residual, const PatchField& radiosity) const;
  /// The relative residual at which the stopping rule will presumably hold.
  double target() const;

  /// For methods whose residual can only fall where the series converges: a few rises in a row mean
  /// divergence.
  void expect_decrease() { expects_decrease_ = true; }
  const SolveReport& report() const { return *report_; }
  SolveReport& report() { return *report_; }

 private:
  double bound_of(const PatchField& residual, const PatchField& radiosity) const;
  bool holds(const Iteration& iteration, double margin) const;
  bool record(Iteration iteration);
  void count_falls(double measure);
  bool progress(const Iteration& iteration);
  bool power_rises(const PatchField& residual, const PatchField& radiosity);
  std::string row_gain() const;

  const RadiositySystem* system_;
  const SolveOptions* options_;
  const ErrorBound* bound_;
  SolveReport* report_;
  bool expects_decrease_ = false;
  double margin_ = 1;
  double best_ = std::numeric_limits<double>::infinity();
  int since_best_ = 0;
  double last_ = std::numeric_limits<double>::infinity();
  int falls_ = 0;             // of the residual, in a row
  Eigen::RowVectorXd power_;  ///< of the last residual, each channel
  Eigen::RowVectorXi rises_;  ///< in a row, each channel
};

}  // namespace luxel
