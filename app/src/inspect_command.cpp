#include "assembly.h"
#include "luxel/plan.h"
#include "memory_plan.h"
#include "progress_bar.h"
#include "reporting.h"
#include "run_command.h"
#include "usage.h"

namespace luxel::app {

namespace {

/// Of the operator that solve would choose; dense is known better here, where the plan is made.
Report::Estimate estimate(const PatchMesh& mesh, const Plan& plan, const Enclosures& enclosures,
                          std::size_t memory) {
  PlanOptions options;
  options.error_bar = true;
  const OperatorChoice choice = choose_operator(mesh, options, static_cast<double>(memory_limit(memory)));
  Cost cost;
  if (choice.kind == OperatorKind::dense) {
    cost = estimated_cost(plan, mesh, enclosures);
  } else {
    for (const OperatorEstimate& each : choice.estimates) {
      if (each.kind == choice.kind) cost = each.cost;
    }
  }
  return {std::string(name(choice.kind)), cost.cpu_seconds, static_cast<std::uint64_t>(cost.bytes)};
}

}  // namespace

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
  report.estimate = estimate(mesh, plan, enclosures, command.general.memory);
  add_run_figures(report, watch);
  show(report, command.general, {});
  return done;
}

}  // namespace luxel::app
