#pragma once

#include <vector>

#include "assembly.h"
#include "commands.h"
#include "luxel/plan.h"
#include "luxel/report.h"
#include "progress_bar.h"
#include "usage.h"

namespace luxel::app {

/// What the command line asks of a plan.
PlanOptions plan_options(const SolveCommand& command);

/// Runs a plan with the clocks that the library does not read: what each stage takes, and the history.
class PlannedRun {
 public:
  /// @param on_iteration  told of each iteration; false stops
  PlannedRun(const SolveCommand& command, std::function<bool(const Iteration&)> on_iteration);

  /// Chooses the operator, assembles and solves system by system; fills in report.transport, solver, energy,
  /// error and left_out.
  /// @throws InputError if --memory does not suffice; Cancelled; SingularSystem
  RadiositySolution run(Assembly& assembly, const Progress& progress, Report& report);

 private:
  OperatorKind chosen_operator(const Assembly& assembly);
  PlannedSolution follow_plan(Assembly& assembly, const Progress& progress, Report& report);
  PlannedSolution gather(Assembly& assembly, const Progress& progress, Report& report);
  PlannedSolution by_clusters(Assembly& assembly, const Progress& progress, Report& report);
  void plan(const Assembly& assembly, const Enclosures& enclosures, Report& report);
  PlanListener listener(const Progress& progress);
  void enter(PlanStage stage);
  bool record(const Iteration& iteration);
  void report_systems(Assembly& assembly, const PlannedSolution& light, Report& report) const;
  void report_gather(Assembly& assembly, const GatheredRun& run, Report& report) const;
  void report_solver(const PlannedSolution& light, Report& report) const;
  std::vector<Report::HistoryEntry> history(const std::vector<Iteration>& iterations) const;

  const SolveCommand& command_;
  std::function<bool(const Iteration&)> on_iteration_;
  PlanOptions options_;
  Plan plan_;
  Stopwatch watch_;
  int patches_ = 0;
  PlanStage stage_ = PlanStage::assembling;
  Seconds stage_start_, assembling_, solving_, measuring_;
  std::vector<Report::Operator::Candidate> candidates_;
  std::vector<std::vector<Seconds>> times_;  ///< of each system's iterations, since its solve began
};

}  // namespace luxel::app
