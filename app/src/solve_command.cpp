#include <cmath>

#include "assembly.h"
#include "interruption.h"
#include "luxel/input_error.h"
#include "output_files.h"
#include "progress_bar.h"
#include "reporting.h"
#include "run_command.h"
#include "solution_files.h"
#include "usage.h"

namespace luxel::app {

namespace {

// The options of one solve with the clocks that the library does not read: history and Ctrl-C.
SolveOptions watched(const SolveOptions& options, const Stopwatch& watch, ProgressBar& bar,
                     std::vector<Report::HistoryEntry>& history, SolutionFiles& files) {
  SolveOptions watched = options;
  if (options.bounces) watched.method = Method::neumann;
  watched.on_iteration =
      [&, last = options.bounces.value_or(options.max_iterations)](const Iteration& iteration) {
        const Seconds now = watch.elapsed();
        history.push_back({iteration.number, now.wall, now.cpu, iteration.relative_residual, not_known});
        files.add_step(iteration);
        return bar("solving", iteration.number, last);
      };
  return watched;
}

void add_solver(Report& report, const SolveReport& solved, const Seconds& seconds,
                std::vector<Report::HistoryEntry> history) {
  Report::Solver figures;
  figures.method = name(solved.method);
  figures.iterations = solved.iterations;
  figures.converged = solved.converged;
  figures.relative_residual = solved.relative_residual;
  figures.error_bound = solved.error_bound;
  figures.cpu_seconds = seconds.cpu;
  figures.wall_seconds = seconds.wall;
  figures.message = solved.message;
  figures.history = std::move(history);
  report.solver = figures;
  report.error = Report::Error{.algebraic = solved.error_bound};
}

void add_energy(Report& report, const Energy& energy) {
  Report::Energy figures;
  for (int channel = 0; channel < 3; ++channel) {
    figures.emitted[channel] = energy.emitted[channel];
    figures.absorbed[channel] = energy.absorbed[channel];
    figures.escaped[channel] = energy.escaped[channel];
  }
  figures.imbalance = energy.imbalance;
  report.energy = figures;
}

}  // namespace

ExitStatus run(const SolveCommand& command) {
  const Stopwatch watch;
  check_outputs(command.outputs, solution_extensions(), command.scene.file);
  if (!command.transport.save.empty()) check_output(command.transport.save, command.scene.file);
  Report report = new_report("solve");
  ProgressBar bar(!command.general.quiet);
  const Progress progress = std::ref(bar);

  const Assembly assembly =
      assemble(command.scene, command.transport, command.general, command.solve.method, progress, report);
  const PatchMesh& mesh = assembly.mesh;
  const TransportOperator& transport = *assembly.transport;
  const PatchField rho = reflectance(mesh), emitted = emission(mesh);
  if ((emitted.array() == 0).all()) {
    report.scene.warnings.push_back(
        "nothing emits (no Ke, exitance, radiance or power), so all light is exactly 0");
  }

  const Stopwatch solve_watch;
  std::vector<Report::HistoryEntry> history;
  SolutionFiles files(command, assembly);
  const RadiositySolution solution =
      solve(transport, rho, emitted, watched(command.solve, solve_watch, bar, history, files));
  if (interruption_requested()) throw Cancelled();
  add_solver(report, solution.report, solve_watch.elapsed(), std::move(history));
  add_energy(report, energy(transport, rho, emitted, solution));

  add_run_figures(report, watch);
  files.write(solution, report, progress);
  add_run_figures(report, watch);
  files.write_report(report);
  show(report, command.general, command.outputs);

  const bool solved = solution.report.converged || solution.report.stopped == Stopped::bounces;
  return solved && accuracy_reached(assembly, false) ? done : not_reached;
}

}  // namespace luxel::app
