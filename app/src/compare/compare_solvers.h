#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "luxel/solve.h"

namespace luxel::compare {

/// One point of a run's curve. Times are the solver's own: what measuring the error costs is left out.
struct HistoryPoint {
  int iteration = 0;
  double wall_seconds = 0;
  double cpu_seconds = 0;
  double relative_residual = 0;
  double error = 0;        ///< max |B - B*| / max |B*|; NaN where the method has no B at hand
  double error_bound = 0;  ///< infinity where there is none
};

/// What one solver did on one operator.
struct Run {
  std::string transport;  ///< kind of the operator
  double accuracy = 0;    ///< asked of the operator
  int patches = 0;
  Method method = Method::cg;
  int right_hand_sides = 3;
  int iterations = 0;
  bool converged = false;
  std::string stopped;  ///< empty, "budget", "diverged" or "stagnated"
  double wall_seconds = 0;
  double cpu_seconds = 0;
  double relative_residual = 0;
  double error = 0;
  double error_bound = 0;
  double condition_estimate = 0;
  /// How far this operator's solution is from the first one's, max |B* - B*_1| / max |B*_1|; NaN for the
  /// first operator itself and where the patches are others.
  double operator_error = std::numeric_limits<double>::quiet_NaN();
  std::string message;
  std::vector<HistoryPoint> history;
};

/// A solution to measure errors against.
struct Reference {
  std::string kind;      ///< "cholesky", "lu", "cg" or "file"
  double error = 0;      ///< its own error bound; NaN for a file
  PatchField radiosity;  ///< N x m
};

struct CompareOptions {
  std::vector<Method> methods;    ///< in the order to run
  double tolerance = 1e-10;       ///< relative residual asked of each
  double budget_factor = 10;      ///< a run is stopped after so many times the median of those before it
  double smallest_budget = 5;     ///< [CPU s]; a factorisation cannot be stopped halfway
  std::function<bool()> stopped;  ///< asked now and then; true cancels with Cancelled
};

/// The best solution of the system at hand: direct with refinement where the operator has entries, else
/// iterative to rounding.
Reference reference_solution(const TransportOperator& transport, const PatchField& reflectance,
                             const PatchField& emission);

/// Runs every method on the same system, the quick ones first, so that the slow ones have a measure to be
/// stopped by.
std::vector<Run> compare_solvers(const TransportOperator& transport, const PatchField& reflectance,
                                 const PatchField& emission, const Reference& reference,
                                 const CompareOptions& options);

/// max |B - B*| / max |B*| over patches and channels.
double relative_error(const PatchField& radiosity, const PatchField& reference);

/// All methods that the operator allows, quick ones first.
std::vector<Method> methods_for(const TransportOperator& transport);

/// The cheapest of the runs that reached an error, for each target: what a work-precision table holds.
struct Cheapest {
  double target = 0;
  int right_hand_sides = 0;
  Method method = Method::cg;
  double cpu_seconds = std::numeric_limits<double>::infinity();  ///< infinity: none reached it
};

std::vector<Cheapest> cheapest_solvers(const std::vector<Run>& runs, const std::vector<double>& targets);

}  // namespace luxel::compare
