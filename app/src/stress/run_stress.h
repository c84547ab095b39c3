#pragma once

#include <string>
#include <vector>

#include "stress/stress_case.h"

namespace luxel::stress {

/// What one solver came to on one case.
struct SolverVerdict {
  Method method = Method::cg;
  Verdict verdict = Verdict::failed;
  double error = 0;        ///< against the expectation; NaN without a result
  double error_bound = 0;  ///< as reported; infinity where there is none
  double relative_residual = 0;
  int iterations = 0;
  std::string message;   ///< why it was refused, stopped or failed
  bool allowed = false;  ///< whether the case allows the verdict
};

struct CaseVerdicts {
  StressCase stress_case;
  std::vector<SolverVerdict> solvers;
};

/// "exact", "bounded", "refused", "failed".
std::string_view name(Verdict verdict);
/// "value", "bounds", "singular", "limit".
std::string_view name(ExpectationKind kind);

/// Runs one case through the methods given; each run may take this many CPU seconds before it is stopped.
CaseVerdicts run_case(const StressCase& stress_case, const std::vector<Method>& methods,
                      double cpu_seconds_each);

/// max |B - [low, high]| / max |B*| over the patches that the expectation names; 0 within.
double expectation_error(const Expectation& expected, const PatchField& radiosity);

}  // namespace luxel::stress
