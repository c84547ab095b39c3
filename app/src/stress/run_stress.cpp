#include "stress/run_stress.h"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "luxel/input_error.h"

namespace luxel::stress {

namespace {

// A bound above this says too little to be called an answer.
constexpr double largest_useful_bound = 1e-2;

double process_cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return now.tv_sec + 1e-9 * now.tv_nsec;
}

Verdict judge(const Expectation& expected, const SolverVerdict& run, bool converged, bool over_budget) {
  if (expected.kind == ExpectationKind::singular) return Verdict::failed;  // a number where there is none
  if (run.error <= expected.tolerance) return Verdict::exact;
  const bool holds = run.error <= run.error_bound && std::isfinite(run.error_bound);
  if (holds && (over_budget || run.error_bound <= largest_useful_bound)) return Verdict::bounded;
  if (!converged && !over_budget && !run.message.empty()) return Verdict::refused;
  return Verdict::failed;
}

SolverVerdict run_method(const StressCase& stress_case, const Problem& problem, Method method,
                         double cpu_seconds) {
  SolverVerdict result;
  result.method = method;
  result.error = result.error_bound = result.relative_residual = std::nan("");
  bool over_budget = false;
  const double start = process_cpu_seconds();
  SolveOptions options;
  options.method = method;
  options.tolerance = stress_case.tolerance;
  options.max_iterations = std::numeric_limits<int>::max();
  options.on_iteration = [&](const Iteration&) {
    over_budget = process_cpu_seconds() - start > cpu_seconds;
    return !over_budget;
  };
  try {
    const RadiositySolution solution =
        solve(*problem.transport, problem.reflectance, problem.emission, options);
    const SolveReport& report = solution.report;
    result.message = over_budget ? "stopped by its budget" : report.message;
    result.iterations = report.iterations;
    const bool no_result =
        report.stopped == Stopped::diverged && !report.converged && !report.message.empty();
    if (no_result) {
      result.verdict = Verdict::refused;
    } else {
      result.relative_residual = report.relative_residual;
      result.error_bound = report.error_bound;
      result.error = expectation_error(stress_case.expected, solution.radiosity);
      result.verdict = judge(stress_case.expected, result, report.converged, over_budget);
    }
  } catch (const SingularSystem& refusal) {
    result.verdict = Verdict::refused;
    result.message = refusal.what();
  } catch (const InputError& refusal) {
    result.verdict = Verdict::refused;
    result.message = refusal.what();
  }
  result.allowed = std::ranges::count(stress_case.allowed, result.verdict) > 0;
  return result;
}

}  // namespace

std::string_view name(Verdict verdict) {
  switch (verdict) {
    case Verdict::exact:
      return "exact";
    case Verdict::bounded:
      return "bounded";
    case Verdict::refused:
      return "refused";
    case Verdict::failed:
      break;
  }
  return "failed";
}

std::string_view name(ExpectationKind kind) {
  switch (kind) {
    case ExpectationKind::value:
      return "value";
    case ExpectationKind::bounds:
      return "bounds";
    case ExpectationKind::singular:
      return "singular";
    case ExpectationKind::limit:
      break;
  }
  return "limit";
}

double expectation_error(const Expectation& expected, const PatchField& radiosity) {
  double largest = 0, deviation = 0;
  for (const PatchValue& value : expected.radiosity) {
    const double b = radiosity(value.patch, 0);
    if (!std::isfinite(b)) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, value.high);
    deviation = std::max({deviation, value.low - b, b - value.high});
  }
  return largest > 0 ? deviation / largest : deviation;
}

CaseVerdicts run_case(const StressCase& stress_case, const std::vector<Method>& methods,
                      double cpu_seconds_each) {
  CaseVerdicts result{stress_case, {}};
  const Problem problem = stress_case.problem();
  for (Method method : methods) {
    result.solvers.push_back(run_method(stress_case, problem, method, cpu_seconds_each));
  }
  return result;
}

}  // namespace luxel::stress
