#include "planned_run.h"

#include <algorithm>
#include <utility>

#include "freed_memory.h"
#include "memory_plan.h"
#include "operator_use.h"
#include "output_files.h"

namespace luxel::app {

namespace {

Seconds operator-(const Seconds& a, const Seconds& b) {
  return {a.cpu - b.cpu, a.wall - b.wall};
}

void operator+=(Seconds& sum, const Seconds& part) {
  sum.cpu += part.cpu;
  sum.wall += part.wall;
}

Report::Energy figures_of(const Energy& energy) {
  Report::Energy figures;
  for (int channel = 0; channel < 3; ++channel) {
    figures.emitted[channel] = energy.emitted[channel];
    figures.absorbed[channel] = energy.absorbed[channel];
    figures.escaped[channel] = energy.escaped[channel];
  }
  figures.imbalance = energy.imbalance;
  return figures;
}

}  // namespace

PlanOptions plan_options(const SolveCommand& command) {
  PlanOptions options;
  options.savings = command.savings;
  options.form_factors = command.transport.form_factors;
  options.solve = command.solve;
  if (command.solve.bounces) options.solve.method = Method::neumann;
  options.error_bar = command.error_bar && !command.solve.bounces;
  options.keep_partial = command.keep_partial;
  options.everything = !command.transport.load.empty() || !command.transport.save.empty();
  // a time series shows the whole scene at each step
  options.together = std::any_of(command.outputs.begin(), command.outputs.end(),
                                 [](const std::string& file) { return extension_of(file) == ".pvd"; });
  return options;
}

PlannedRun::PlannedRun(const SolveCommand& command, std::function<bool(const Iteration&)> on_iteration)
    : command_(command), on_iteration_(std::move(on_iteration)), options_(plan_options(command)) {
  options_.solve.on_iteration = [this](const Iteration& iteration) { return record(iteration); };
}

RadiositySolution PlannedRun::run(Assembly& assembly, const Progress& progress, Report& report) {
  watch_ = Stopwatch();
  stage_start_ = {};
  patches_ = assembly.mesh.size();
  return_freed_memory(patches_);
  PlannedSolution light;
  switch (chosen_operator(assembly)) {
    case OperatorKind::gather:
      light = gather(assembly, progress, report);
      break;
    case OperatorKind::hierarchical:
      light = by_clusters(assembly, progress, report);
      break;
    default:
      light = follow_plan(assembly, progress, report);
  }
  report.transport->candidates = candidates_;
  report_solver(light, report);
  if (light.operator_error) assembly.operator_error = *light.operator_error;
  return std::move(light.solution);
}

/// As asked, or as the scene calls for where all that is asked allows it.
OperatorKind PlannedRun::chosen_operator(const Assembly& assembly) {
  if (assembly.transport) return OperatorKind::dense;
  if (command_.transport.kind != OperatorKind::automatic) return command_.transport.kind;
  if (!operator_cannot(OperatorKind::gather, command_).empty()) return OperatorKind::dense;
  const OperatorChoice choice =
      choose_operator(assembly.mesh, options_, static_cast<double>(memory_limit(command_.general.memory)));
  for (const OperatorEstimate& each : choice.estimates) {
    candidates_.push_back({std::string(name(each.kind)), each.cost.cpu_seconds,
                           static_cast<std::uint64_t>(each.cost.bytes), each.fits});
  }
  return choice.kind;
}

PlannedSolution PlannedRun::follow_plan(Assembly& assembly, const Progress& progress, Report& report) {
  const bool at_hand = assembly.transport != nullptr;
  Enclosures& enclosures = assembly.record.enclosures;
  if (!at_hand) enclosures = planned_enclosures(assembly.mesh, options_, progress);
  plan(assembly, enclosures, report);
  PlannedSolution light =
      at_hand ? run_plan(plan_, *assembly.transport, assembly.mesh, options_, listener(progress))
              : run_plan(plan_, assembly.mesh, enclosures, options_, listener(progress));
  if (!at_hand) report_systems(assembly, light, report);
  return light;
}

PlannedSolution PlannedRun::gather(Assembly& assembly, const Progress& progress, Report& report) {
  const Cost cost = estimated_gather_cost(assembly.mesh, options_);
  check_memory(static_cast<std::size_t>(cost.bytes), command_.general.memory, assembly.mesh.size());
  GatheredRun run = run_gathered(assembly.mesh, options_, listener(progress));
  for (const LeftOut& item : run.left_out) report.left_out.push_back({item.what, item.why, item.saved});
  report_gather(assembly, run, report);
  return std::move(run.light);
}

PlannedSolution PlannedRun::by_clusters(Assembly& assembly, const Progress& progress, Report& report) {
  const Cost cost = estimated_hierarchical_cost(assembly.mesh, options_);
  check_memory(static_cast<std::size_t>(cost.bytes), command_.general.memory, assembly.mesh.size());
  HierarchicalRun run = run_hierarchical(assembly.mesh, options_, listener(progress));
  for (const LeftOut& item : run.left_out) report.left_out.push_back({item.what, item.why, item.saved});
  OperatorRecord& record = assembly.record;
  record.options = options_.form_factors;
  record.enclosures = std::move(run.enclosures);
  record.form_factors.rays = run.hierarchical.rays;
  record.closure = run.light.closure;
  assembly.rows.max = run.light.closure.before.max;
  assembly.rows.rms = run.light.closure.before.rms;
  report_operator(assembly, "hierarchical", run.light.operator_bytes, assembling_, report);
  return std::move(run.light);
}

void PlannedRun::plan(const Assembly& assembly, const Enclosures& enclosures, Report& report) {
  plan_ = make_plan(assembly.mesh, enclosures, options_);
  for (const LeftOut& item : plan_.left_out) report.left_out.push_back({item.what, item.why, item.saved});
  check_memory(static_cast<std::size_t>(planned_bytes(plan_)), command_.general.memory, assembly.mesh.size());
}

PlanListener PlannedRun::listener(const Progress& progress) {
  return {progress, [this](PlanStage stage) { enter(stage); }};
}

void PlannedRun::enter(PlanStage stage) {
  return_freed_memory(patches_);
  const Seconds now = watch_.elapsed();
  (stage_ == PlanStage::assembling ? assembling_
   : stage_ == PlanStage::solving  ? solving_
                                   : measuring_) += now - stage_start_;
  stage_ = stage;
  stage_start_ = now;
}

bool PlannedRun::record(const Iteration& iteration) {
  if (iteration.number == 0) times_.emplace_back();
  times_.back().push_back(watch_.elapsed() - stage_start_);
  return on_iteration_(iteration);
}

void PlannedRun::report_systems(Assembly& assembly, const PlannedSolution& light, Report& report) const {
  OperatorRecord& record = assembly.record;
  record.options = options_.form_factors;
  record.form_factors = light.form_factors;
  record.closure = light.closure;
  take_sky_shares(record.enclosures, light.sky_shares, options_.form_factors.accuracy);
  assembly.rows = row_errors(light.row_sums, assembly.mesh.areas, record.enclosures);
  report_operator(assembly, "dense", light.operator_bytes, assembling_, report);
}

void PlannedRun::report_gather(Assembly& assembly, const GatheredRun& run, Report& report) const {
  OperatorRecord& record = assembly.record;
  record.options = options_.form_factors;
  record.enclosures = run.enclosures;
  record.form_factors.rays = run.light.rays;
  // rows are compared with rays of their own on the patches of the error bar; in closed enclosures no ray was
  // lost
  if (run.light.operator_error) {
    assembly.rows.max = run.light.operator_error->row_sum_error_max;
    assembly.rows.rms = run.light.operator_error->row_sum_error_rms;
  } else {
    assembly.rows.max = assembly.rows.rms = run.enclosures.closed ? 0 : not_known;
  }
  report_operator(assembly, "gather", run.light.operator_bytes, assembling_, report);
  report.transport->reciprocity_error = run.light.reciprocity_error;
}

void PlannedRun::report_solver(const PlannedSolution& light, Report& report) const {
  const SolveReport& solved = light.solution.report;
  Report::Solver figures;
  figures.method = name(solved.method);
  figures.iterations = solved.iterations;
  figures.converged = solved.converged;
  figures.relative_residual = solved.relative_residual;
  figures.error_bound = solved.error_bound;
  if (solved.condition_estimate > 0) figures.condition_estimate = solved.condition_estimate;
  figures.cpu_seconds = solving_.cpu;
  figures.wall_seconds = solving_.wall;
  figures.message = solved.message;
  figures.history = history(solved.history);
  report.solver = figures;
  report.error = Report::Error{.algebraic = solved.error_bound};
  if (light.operator_error) {
    report.error->operator_estimate = light.operator_error->estimate;
    report.error->operator_low = light.operator_error->low;
    report.error->operator_high = light.operator_error->high;
  }
  report.energy = figures_of(light.energy);
}

// Systems are solved one after the other: iteration k of all is done when each has done k, or is done.
std::vector<Report::HistoryEntry> PlannedRun::history(const std::vector<Iteration>& iterations) const {
  std::vector<Report::HistoryEntry> entries;
  for (std::size_t k = 0; k < iterations.size(); ++k) {
    Seconds spent;
    for (const auto& times : times_) spent += times[std::min(k, times.size() - 1)];
    entries.push_back(
        {iterations[k].number, spent.wall, spent.cpu, iterations[k].relative_residual, not_known});
  }
  return entries;
}

}  // namespace luxel::app
