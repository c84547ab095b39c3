#include <algorithm>
#include <limits>
#include <utility>

#include "luxel/input_error.h"
#include "luxel/plan.h"
#include "plan/cost_model.h"
#include "plan/decisions.h"
#include "plan/error_bar.h"
#include "plan/solved_channels.h"

namespace luxel {

namespace {

// Rays of all patches together that tell enclosures which the surfaces do not prove, and those of each patch.
constexpr double enclosure_rays = 4e6;
constexpr int least_rays = 16, most_rays = 256;

HierarchicalOptions hierarchical_options(const PlanOptions& options) {
  HierarchicalOptions hierarchical;
  hierarchical.accuracy = std::clamp(options.form_factors.accuracy, 1e-4, 0.3);
  hierarchical.seed = options.form_factors.seed;
  return hierarchical;
}

Enclosures enclosures_of(const PatchMesh& mesh, const PlanOptions& options, const RayScene& occluders,
                         const Progress& progress) {
  if (options.savings.idle_occluders && convex_inside(mesh)) return planned_enclosures(mesh, options);
  const int rays =
      std::clamp(static_cast<int>(enclosure_rays / std::max(1, mesh.size())), least_rays, most_rays);
  return find_enclosures(mesh, occluders, rays, progress);
}

}  // namespace

HierarchicalRun run_hierarchical(const PatchMesh& mesh, const PlanOptions& options,
                                 const PlanListener& listener) {
  const auto enter = [&](PlanStage stage) {
    if (listener.on_stage) listener.on_stage(stage);
  };
  enter(PlanStage::assembling);
  const PatchField rho = reflectance(mesh), emitted = emission(mesh);
  const RayScene occluders(mesh.occluders);
  HierarchicalRun run;
  run.enclosures = enclosures_of(mesh, options, occluders, listener.progress);
  SolveOptions solving = options.solve;
  bool first = true;
  solving.on_iteration = [&, tell = options.solve.on_iteration](const Iteration& iteration) {
    if (std::exchange(first, false)) enter(PlanStage::solving);
    return !tell || tell(iteration);
  };
  HierarchicalSolution solution = solve_hierarchical(
      mesh, run.enclosures, rho, emitted, hierarchical_options(options), solving, listener.progress);
  PlannedSolution& planned = run.light;
  planned.solution = std::move(solution.light);
  const HierarchicalOperator& transport = *solution.transport;
  run.hierarchical = transport.report();
  planned.closure = run.hierarchical.closure;
  planned.row_sums.assign(transport.row_sums().begin(), transport.row_sums().end());
  planned.operator_bytes = transport.bytes();
  planned.rays = run.enclosures.rays + run.hierarchical.rays;
  planned.energy = energy(transport, rho, emitted, planned.solution);
  solution.transport.reset();
  note(run.left_out, black_patches(rho));

  const bool stopped = planned.solution.report.stopped == Stopped::caller;
  if (options.error_bar && !stopped && (emitted.array() > 0).any()) {
    enter(PlanStage::measuring);
    const double seconds =
        block_seconds(static_cast<double>(run.hierarchical.bytes), static_cast<double>(planned.rays));
    const OperatorErrorOptions probing = error_bar_options(mesh, options, seconds);
    try {
      planned.operator_error =
          operator_error(mesh, occluders, rho, emitted, planned.solution, {}, probing, listener.progress);
    } catch (const Cancelled&) {
      if (!options.keep_partial) throw;
    }
  }
  enter(PlanStage::done);
  return run;
}

Cost estimated_hierarchical_cost(const PatchMesh& mesh, const PlanOptions& options) {
  const double patches = mesh.size();
  Cost cost;
  cost.cpu_seconds = mesh_seconds(patches) + hierarchical_seconds(patches, options.form_factors.accuracy);
  if (options.error_bar) cost.cpu_seconds *= 1 + error_bar_share;
  cost.bytes = hierarchical_bytes(patches, options.form_factors.accuracy);
  return cost;
}

}  // namespace luxel
