#include "compare/compare_solvers.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

#include "luxel/input_error.h"

namespace luxel::compare {

namespace {

// A clock that can be held while the comparison does its own work.
class SolverClock {
 public:
  SolverClock() { resume(); }
  void hold() {
    cpu_ += cpu_now() - cpu_start_;
    wall_ += wall_now() - wall_start_;
  }
  void resume() {
    cpu_start_ = cpu_now();
    wall_start_ = wall_now();
  }
  double cpu() const { return cpu_; }
  double wall() const { return wall_; }

 private:
  static double cpu_now() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return now.tv_sec + 1e-9 * now.tv_nsec;
  }
  static double wall_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  }
  double cpu_ = 0, wall_ = 0, cpu_start_ = 0, wall_start_ = 0;
};

std::string stop_name(const SolveReport& report, bool over_budget) {
  if (over_budget) return "budget";
  if (report.stopped == Stopped::diverged) return "diverged";
  if (report.stopped == Stopped::stagnated) return "stagnated";
  return "";
}

Run run_method(const TransportOperator& transport, const PatchField& reflectance, const PatchField& emission,
               const Reference& reference, Method method, double budget, const CompareOptions& options) {
  Run run;
  run.transport = transport.kind();
  run.patches = transport.size();
  run.method = method;
  run.right_hand_sides = static_cast<int>(emission.cols());
  bool over_budget = false, cancelled = false;
  SolverClock clock;
  SolveOptions solve_options;
  solve_options.method = method;
  solve_options.tolerance = options.tolerance;
  solve_options.max_iterations = std::numeric_limits<int>::max();
  solve_options.on_iteration = [&](const Iteration& iteration) {
    clock.hold();
    const double error =
        iteration.radiosity ? relative_error(*iteration.radiosity, reference.radiosity) : std::nan("");
    run.history.push_back({iteration.number, clock.wall(), clock.cpu(), iteration.relative_residual, error,
                           iteration.error_bound});
    over_budget = clock.cpu() > budget;
    cancelled = options.stopped && options.stopped();
    clock.resume();
    return !over_budget && !cancelled;
  };
  try {
    const RadiositySolution solution = solve(transport, reflectance, emission, solve_options);
    clock.hold();
    if (cancelled) throw Cancelled();
    const SolveReport& report = solution.report;
    run.iterations = report.iterations;
    run.converged = report.converged;
    run.stopped = stop_name(report, over_budget);
    run.relative_residual = report.relative_residual;
    run.error_bound = report.error_bound;
    run.condition_estimate = report.condition_estimate;
    run.message = report.message;
    run.error = relative_error(solution.radiosity, reference.radiosity);
    run.history.push_back(
        {run.iterations, clock.wall(), clock.cpu(), run.relative_residual, run.error, run.error_bound});
  } catch (const SingularSystem& refusal) {
    clock.hold();
    run.message = refusal.what();
    run.error = run.error_bound = run.relative_residual = std::nan("");
  }
  run.cpu_seconds = clock.cpu();
  run.wall_seconds = clock.wall();
  return run;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

}  // namespace

double relative_error(const PatchField& radiosity, const PatchField& reference) {
  const double largest = reference.cwiseAbs().maxCoeff();
  const double deviation = (radiosity - reference).cwiseAbs().maxCoeff();
  return largest > 0 ? deviation / largest : deviation;
}

std::vector<Method> methods_for(const TransportOperator& transport) {
  std::vector<Method> methods;
  if (transport.symmetric()) methods.push_back(Method::cg);
  methods.push_back(Method::gmres);
  if (transport.entries()) {
    if (transport.symmetric()) methods.push_back(Method::cholesky);
    methods.insert(methods.end(), {Method::gauss_seidel, Method::symmetric_gauss_seidel});
  }
  methods.push_back(Method::neumann);
  if (transport.entries()) methods.insert(methods.end(), {Method::lu, Method::southwell});
  return methods;
}

Reference reference_solution(const TransportOperator& transport, const PatchField& reflectance,
                             const PatchField& emission) {
  SolveOptions options;
  options.method = !transport.entries()    ? Method::gmres
                   : transport.symmetric() ? Method::cholesky
                                           : Method::lu;
  options.tolerance = 1e-14;  // refinement goes on until it stops gaining
  RadiositySolution solution = solve(transport, reflectance, emission, options);
  return {std::string(name(options.method)), solution.report.error_bound, std::move(solution.radiosity)};
}

std::vector<Run> compare_solvers(const TransportOperator& transport, const PatchField& reflectance,
                                 const PatchField& emission, const Reference& reference,
                                 const CompareOptions& options) {
  std::vector<Run> runs;
  std::vector<double> seconds;
  for (Method method : options.methods) {
    const double budget = seconds.empty()
                              ? std::numeric_limits<double>::infinity()
                              : std::max(options.smallest_budget, options.budget_factor * median(seconds));
    runs.push_back(run_method(transport, reflectance, emission, reference, method, budget, options));
    seconds.push_back(runs.back().cpu_seconds);
  }
  return runs;
}

std::vector<Cheapest> cheapest_solvers(const std::vector<Run>& runs, const std::vector<double>& targets) {
  std::vector<Cheapest> table;
  for (const Run& run : runs) {
    for (double target : targets) {
      auto row = std::ranges::find_if(table, [&](const Cheapest& cheapest) {
        return cheapest.target == target && cheapest.right_hand_sides == run.right_hand_sides;
      });
      if (row == table.end()) row = table.insert(row, {target, run.right_hand_sides});
      const auto reached =
          std::ranges::find_if(run.history, [&](const HistoryPoint& point) { return point.error <= target; });
      if (reached != run.history.end() && reached->cpu_seconds < row->cpu_seconds) {
        row->cpu_seconds = reached->cpu_seconds;
        row->method = run.method;
      }
    }
  }
  return table;
}

}  // namespace luxel::compare
