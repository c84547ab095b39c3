#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "luxel/input_error.h"
#include "luxel/plan.h"
#include "operator_error/coarse_exchange.h"
#include "operator_error/strata.h"
#include "plan/cost_model.h"
#include "plan/dark_enclosures.h"
#include "plan/decisions.h"
#include "plan/error_bar.h"
#include "plan/gathered_enclosures.h"
#include "plan/solved_channels.h"
#include "plan/with_dark.h"
#include "transport/gather/gathered_light.h"

namespace luxel {

namespace {

// Where nothing emits, rays are cast only to tell the enclosures.
constexpr int least_rays = 16;

// Parts of the scene between which reciprocity is looked at.
constexpr int reciprocity_parts = 64;

/// Whether nothing is absorbed and all is dark: solve() has to be asked whether that is singular.
std::vector<char> lossless_channels(const PatchField& rho) {
  std::vector<char> lossless(rho.cols());
  for (Eigen::Index c = 0; c < rho.cols(); ++c) lossless[c] = (rho.col(c).array() >= 1 - smallest_loss).all();
  return lossless;
}

double reciprocity_error(const GatherOperator& stored) {
  const Strata strata(stored.packets(), {stored.areas().begin(), stored.areas().end()});
  return coarse_exchange(stored, strata.of_patch(reciprocity_parts), reciprocity_parts).reciprocity_error;
}

Energy energy_of(const PatchMesh& mesh, const PatchField& rho, const PatchField& emitted,
                 const RadiositySolution& light, const std::vector<double>& row_sums) {
  Energy energy;
  energy.emitted = energy.absorbed = energy.escaped = Eigen::RowVectorXd::Zero(emitted.cols());
  for (int i = 0; i < mesh.size(); ++i) {
    energy.emitted += mesh.areas[i] * emitted.row(i);
    energy.absorbed += mesh.areas[i] * light.irradiance.row(i).cwiseProduct(
                                           Eigen::RowVectorXd::Ones(rho.cols()) - rho.row(i));
    energy.escaped += mesh.areas[i] * (1 - row_sums[i]) * light.radiosity.row(i);
  }
  for (Eigen::Index c = 0; c < emitted.cols(); ++c) {
    if (energy.emitted[c] == 0) continue;
    const double missing = std::abs(energy.emitted[c] - energy.absorbed[c] - energy.escaped[c]);
    energy.imbalance = std::max(energy.imbalance, missing / energy.emitted[c]);
  }
  return energy;
}

GatherOptions gather_options(const PlanOptions& options) {
  GatherOptions gather;
  gather.accuracy = options.form_factors.accuracy;
  gather.seed = options.form_factors.seed;
  gather.keep_partial = options.keep_partial;
  return gather;
}

void enter(PlanStage stage, const PlanListener& listener) {
  if (listener.on_stage) listener.on_stage(stage);
}

/// All patches in one system.
GatheredRun gathered(const PatchMesh& mesh, const RayScene& occluders, const PlanOptions& options,
                     const PlanListener& listener) {
  const auto enter = [&](PlanStage stage) { luxel::enter(stage, listener); };
  const PatchField rho = reflectance(mesh), emitted = emission(mesh);
  const ChannelPlan channels = options.savings.channels ? plan_channels(rho, emitted, lossless_channels(rho))
                                                        : every_channel(static_cast<int>(rho.cols()));
  GatheredRun run;
  PlannedSolution& planned = run.light;
  note(run.left_out, dark_channels(channels, mesh.size()));
  note(run.left_out, equal_channels(channels, mesh.size()));
  if (options.savings.channels) note(run.left_out, black_patches(rho));
  if (channels.solved.empty()) {
    planned.solution = {emitted, PatchField::Zero(mesh.size(), rho.cols()), {}};
    planned.solution.report.method = Method::neumann;
    planned.solution.report.converged = true;
    planned.solution.report.error_bound = 0;
    planned.row_sums.assign(mesh.size(), std::numeric_limits<double>::quiet_NaN());
    run.enclosures = find_enclosures(mesh, occluders, least_rays, listener.progress);
    planned.energy = energy_of(mesh, rho, emitted, planned.solution, std::vector<double>(mesh.size(), 1.0));
    return run;
  }

  SolveOptions solving = options.solve;
  if (solving.on_iteration) {
    solving.on_iteration = [&, tell = options.solve.on_iteration](const Iteration& iteration) {
      Iteration told = iteration;
      PatchField whole;
      if (iteration.radiosity && channels.solved.size() < channels.source.size()) {
        whole = expanded(*iteration.radiosity, channels);
        told.radiosity = &whole;
      }
      return tell(told);
    };
  }
  // a million patches: fields are kept once
  const bool all_solved = channels.solved.size() == channels.source.size();
  PatchField rho_part, emitted_part;
  if (!all_solved) {
    rho_part = rho(Eigen::all, channels.solved);
    emitted_part = emitted(Eigen::all, channels.solved);
  }
  const PatchField& rho_solved = all_solved ? rho : rho_part;
  const PatchField& emitted_solved = all_solved ? emitted : emitted_part;
  GatheredLight light =
      gather_light(mesh, occluders, rho_solved, emitted_solved, gather_options(options), solving,
                   listener.progress, [&](GatherStage stage) {
                     enter(stage == GatherStage::rays ? PlanStage::assembling : PlanStage::solving);
                   });
  run.gather = light.solution.report;
  run.enclosures = gathered_enclosures(*light.stored, light.solution.row_sums,
                                       run.gather.partial ? light.stored->rays() : run.gather.plan.rays);
  planned.row_sums = std::move(light.solution.row_sums);
  planned.operator_bytes = run.gather.bytes;
  planned.rays = run.gather.rays + run.gather.shadow_rays;
  planned.reciprocity_error = reciprocity_error(*light.stored);
  light.stored.reset();
  light.rays.reset();

  if (options.error_bar && !run.gather.partial) {
    enter(PlanStage::measuring);
    const double triangles = static_cast<double>(mesh.occluders.triangles.size());
    const double seconds =
        gather_seconds(mesh.size(), static_cast<double>(planned.rays) / mesh.size(), triangles);
    const OperatorErrorOptions probing = error_bar_options(mesh, options, seconds);
    try {
      planned.operator_error =
          operator_error(mesh, occluders, rho_solved, emitted_solved, light.solution.light, planned.row_sums,
                         probing, listener.progress);
    } catch (const Cancelled&) {
      if (!options.keep_partial) throw;
    }
  }
  planned.solution.report = std::move(light.solution.light.report);
  RadiositySolution& found = light.solution.light;
  planned.solution.radiosity = all_solved ? std::move(found.radiosity) : expanded(found.radiosity, channels);
  planned.solution.irradiance =
      all_solved ? std::move(found.irradiance) : expanded(found.irradiance, channels);
  planned.energy = energy_of(mesh, rho, emitted, planned.solution, planned.row_sums);
  return run;
}

/// The same without dark enclosures, whose patches cast no rays and are met by none.
GatheredRun gathered_without(const DarkEnclosures& dark, const PatchMesh& mesh, const PlanOptions& options,
                             const PlanListener& listener) {
  GatheredRun run;
  if (dark.others.empty()) {
    run.light = light_of_none();
  } else {
    const PatchMesh part = sub_mesh(mesh, dark.others, dark.others_closed);
    try {
      run = gathered(part, RayScene(part.occluders), told_of_all(options, dark), listener);
    } catch (const SingularSystem& singular) {
      throw singular_among_all(singular, dark);
    }
  }
  add_dark(run.light, dark);
  run.enclosures = with_dark(run.enclosures, dark);
  run.left_out.insert(run.left_out.begin(), dark_senders(dark.count, dark.patches, mesh.size()));
  return run;
}

}  // namespace

GatheredRun run_gathered(const PatchMesh& mesh, const PlanOptions& options, const PlanListener& listener) {
  enter(PlanStage::assembling, listener);
  GatheredRun run;
  {
    const RayScene occluders(mesh.occluders);
    const DarkEnclosures dark =
        options.savings.dark_enclosures ? dark_enclosures(mesh, occluders) : DarkEnclosures{};
    run = dark.count > 0 ? gathered_without(dark, mesh, options, listener)
                         : gathered(mesh, occluders, options, listener);
  }
  enter(PlanStage::done, listener);
  return run;
}

Cost estimated_gather_cost(const PatchMesh& mesh, const PlanOptions& options) {
  const PatchField emitted = emission(mesh);
  const GatherPlan plan = gather_plan(mesh, emitted, gather_options(options));
  const double patches = mesh.size(), triangles = static_cast<double>(mesh.occluders.triangles.size());
  Cost cost;
  cost.cpu_seconds = mesh_seconds(patches) + gather_seconds(patches, plan.rays, triangles);
  if (options.error_bar) cost.cpu_seconds *= 1 + error_bar_share;
  cost.bytes = gather_bytes(patches, triangles) + static_cast<double>(plan.bytes);
  return cost;
}

}  // namespace luxel
