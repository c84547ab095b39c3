#include <cstdio>

#include "assembly.h"
#include "interruption.h"
#include "luxel/input_error.h"
#include "output_files.h"
#include "planned_run.h"
#include "progress_bar.h"
#include "reporting.h"
#include "run_command.h"
#include "shortfall.h"
#include "solution_files.h"
#include "usage.h"

namespace luxel::app {

ExitStatus run(const SolveCommand& command) {
  const Stopwatch watch;
  check_outputs(command.outputs, solution_extensions(), command.scene.file);
  if (!command.transport.save.empty()) check_output(command.transport.save, command.scene.file);
  Report report = new_report("solve");
  ProgressBar bar(!command.general.quiet);
  const Progress progress = std::ref(bar);

  const bool kept = !command.transport.save.empty() || !command.transport.load.empty();
  Assembly assembly;
  if (kept) {
    assembly =
        assemble(command.scene, command.transport, command.general, command.solve.method, progress, report);
  } else {
    assembly.mesh = read_and_mesh(command.scene, command.general, progress, report);
  }
  if ((emission(assembly.mesh).array() == 0).all()) {
    report.scene.warnings.push_back(
        "nothing emits (no Ke, exitance, radiance or power), so all light is exactly 0");
  }

  SolutionFiles files(command, assembly);
  const int last = command.solve.bounces.value_or(command.solve.max_iterations);
  PlannedRun planned(command, [&](const Iteration& iteration) {
    files.add_step(iteration);
    return bar("solving", iteration.number, last);
  });
  const RadiositySolution solution = planned.run(assembly, progress, report);
  report.partial = interruption_requested();
  if (report.partial && !command.keep_partial) throw Cancelled();
  if (solution.radiosity.maxCoeff() > 0 && solution.irradiance.maxCoeff() == 0) {
    report.scene.warnings.push_back(
        "light arrives nowhere: no patch faces one that shines; are the faces turned inside out?");
  }

  const std::string unconverged = solver_shortfall(solution.report, command.solve);
  const std::string inaccurate = accuracy_shortfall(assembly, false);
  if (!report.partial) {
    for (const std::string& text : {unconverged, inaccurate}) {
      if (!text.empty()) report.scene.warnings.push_back(text);
    }
  }

  add_run_figures(report, watch);
  // a wish to stop has been heard: now it is written
  files.write(solution, report, report.partial ? Progress() : progress);
  add_run_figures(report, watch);
  files.write_report(report);
  show(report, command.general, files.names(report));
  if (report.partial) {
    std::fputs("luxel: stopped; what was solved so far is marked as partial\n", stderr);
    return interrupted;
  }
  return unconverged.empty() && inaccurate.empty() ? done : not_reached;
}

}  // namespace luxel::app
