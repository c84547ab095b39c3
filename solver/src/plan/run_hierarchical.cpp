#include <algorithm>
#include <limits>
#include <utility>

#include "enclosures/cells.h"
#include "enclosures/shells.h"
#include "enclosures/triangle_soup.h"
#include "luxel/input_error.h"
#include "luxel/plan.h"
#include "plan/cost_model.h"
#include "plan/dark_enclosures.h"
#include "plan/decisions.h"
#include "plan/error_bar.h"
#include "plan/solved_channels.h"
#include "plan/with_dark.h"

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

int rays_of_enclosures(int patches) {
  return std::clamp(static_cast<int>(enclosure_rays / std::max(1, patches)), least_rays, most_rays);
}

Enclosures enclosures_of(const PatchMesh& mesh, const PlanOptions& options, const RayScene& occluders,
                         const Progress& progress) {
  if (options.savings.idle_occluders && convex_inside(mesh)) return planned_enclosures(mesh, options);
  return find_enclosures(mesh, occluders, rays_of_enclosures(mesh.size()), progress);
}

void enter(PlanStage stage, const PlanListener& listener) {
  if (listener.on_stage) listener.on_stage(stage);
}

/// Whether enclosures may take rays: the surfaces have free edges, or are too many to be looked at.
bool may_need_rays(const PatchMesh& mesh, const PlanOptions& options) {
  if (mesh.occluders.triangles.size() > most_proven_triangles) return true;
  if (options.savings.idle_occluders && convex_inside(mesh)) return false;
  return !find_shells(TriangleSoup(mesh.occluders, RayScene(mesh.occluders))).rims.empty();
}

/// All patches in one system.
HierarchicalRun by_clusters(const PatchMesh& mesh, const RayScene& occluders, const PlanOptions& options,
                            const PlanListener& listener) {
  const auto enter = [&](PlanStage stage) { luxel::enter(stage, listener); };
  const PatchField rho = reflectance(mesh), emitted = emission(mesh);
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
  return run;
}

/// The same without dark enclosures, of which no cluster is made.
HierarchicalRun by_clusters_without(const DarkEnclosures& dark, const PatchMesh& mesh,
                                    const PlanOptions& options, const PlanListener& listener) {
  HierarchicalRun run;
  if (dark.others.empty()) {
    run.light = light_of_none();
  } else {
    const PatchMesh part = sub_mesh(mesh, dark.others, dark.others_closed);
    try {
      run = by_clusters(part, RayScene(part.occluders), told_of_all(options, dark), listener);
    } catch (const SingularSystem& singular) {
      throw singular_among_all(singular, dark);
    }
  }
  add_dark(run.light, dark);
  run.hierarchical.closure = run.light.closure;
  run.enclosures = with_dark(run.enclosures, dark);
  run.left_out.insert(run.left_out.begin(), dark_senders(dark.count, dark.patches, mesh.size()));
  return run;
}

}  // namespace

HierarchicalRun run_hierarchical(const PatchMesh& mesh, const PlanOptions& options,
                                 const PlanListener& listener) {
  enter(PlanStage::assembling, listener);
  HierarchicalRun run;
  {
    const RayScene occluders(mesh.occluders);
    const DarkEnclosures dark =
        options.savings.dark_enclosures ? dark_enclosures(mesh, occluders) : DarkEnclosures{};
    run = dark.count > 0 ? by_clusters_without(dark, mesh, options, listener)
                         : by_clusters(mesh, occluders, options, listener);
  }
  enter(PlanStage::done, listener);
  return run;
}

Cost estimated_hierarchical_cost(const PatchMesh& mesh, const PlanOptions& options) {
  const double patches = mesh.size();
  Cost cost;
  cost.cpu_seconds = mesh_seconds(patches) + hierarchical_seconds(patches, options.form_factors.accuracy);
  if (may_need_rays(mesh, options)) {
    cost.cpu_seconds += enclosure_seconds(patches * rays_of_enclosures(mesh.size()));
  }
  if (options.error_bar) cost.cpu_seconds *= 1 + error_bar_share;
  cost.bytes = hierarchical_bytes(patches, options.form_factors.accuracy);
  return cost;
}

}  // namespace luxel
