#include "assembly.h"
#include "luxel/plan.h"
#include "progress_bar.h"
#include "reporting.h"
#include "run_command.h"
#include "usage.h"

namespace luxel::app {

ExitStatus run(const InspectCommand& command) {
  const Stopwatch watch;
  Report report = new_report("inspect");
  ProgressBar bar(!command.general.quiet);
  const Progress progress = std::ref(bar);
  const PatchMesh mesh = read_and_mesh(command.scene, command.general, progress, report);
  const Enclosures enclosures = planned_enclosures(mesh, {}, progress);
  report.scene.closed = enclosures.closed;
  report.scene.enclosures = enclosures.count;
  const Plan plan = make_plan(mesh, enclosures);
  for (const LeftOut& item : plan.left_out) report.left_out.push_back({item.what, item.why, item.saved});
  const Cost cost = estimated_cost(plan, mesh, enclosures);
  report.estimate = Report::Estimate{cost.cpu_seconds, static_cast<std::uint64_t>(cost.bytes)};
  add_run_figures(report, watch);
  show(report, command.general, {});
  return done;
}

}  // namespace luxel::app
