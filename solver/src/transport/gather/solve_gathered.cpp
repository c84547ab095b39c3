#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "luxel/gather_operator.h"
#include "luxel/input_error.h"
#include "ordered_sum.h"
#include "transport/gather/final_gather.h"
#include "transport/gather/gathered_light.h"
#include "transport/gather/rays_needed.h"
#include "transport/gather/stored_rays.h"

namespace luxel {

namespace {

// Mean reflectance above which directions are orthogonalised rather than bounces added up.
constexpr double dark = 0.75;

// Memory for these directions, and how many are worth having.
constexpr double bytes_for_directions = 256e6;
constexpr int least_directions = 6;

/// The method for the iteration on U: what the caller asked, or the one with the least memory that converges
/// well.
SolveOptions iteration(const PatchMesh& mesh, const PatchField& reflectance, SolveOptions solving) {
  if (solving.method != Method::automatic) return solving;
  const Eigen::Map<const Eigen::RowVectorXd> areas(mesh.areas.data(), mesh.size());
  const double brightest = mesh.size() == 0 ? 0 : (areas * reflectance).maxCoeff() / ordered_sum(mesh.areas);
  solving.method = brightest > dark ? Method::gmres : Method::neumann;
  const double field = sizeof(double) * static_cast<double>(std::max<Eigen::Index>(1, reflectance.size()));
  solving.restart = std::clamp(static_cast<int>(bytes_for_directions / field), least_directions,
                               std::max(least_directions, solving.restart));
  return solving;
}

/// Area-weighted norms of each column.
Eigen::RowVectorXd norms(const PatchMesh& mesh, const PatchField& field) {
  const Eigen::Map<const Eigen::RowVectorXd> areas(mesh.areas.data(), mesh.size());
  return (areas * field.cwiseAbs2()).cwiseSqrt();
}

/// The largest of part[c] / whole[c] over columns where there is a whole.
double largest_share(const Eigen::RowVectorXd& part, const Eigen::RowVectorXd& whole) {
  double largest = 0;
  for (Eigen::Index c = 0; c < whole.size(); ++c) {
    if (whole[c] > 0) largest = std::max(largest, part[c] / whole[c]);
  }
  return largest;
}

/// Solves for `source`, with the tolerance and the residuals relative to the emission.
RadiositySolution iterate(const PatchMesh& mesh, const GatherOperator& stored, const PatchField& reflectance,
                          const PatchField& emission, PatchField source, bool apart, SolveOptions solving) {
  const Eigen::RowVectorXd emitted = norms(mesh, emission);
  const double relative = largest_share(norms(mesh, source), emitted);
  solving = iteration(mesh, reflectance, solving);
  if (relative > 0) solving.tolerance = std::min(solving.tolerance / relative, 0.5);
  if (solving.on_iteration) {
    solving.on_iteration = [&, tell = solving.on_iteration](const Iteration& iteration) {
      Iteration told = iteration;
      told.relative_residual *= relative;
      PatchField whole;
      if (apart && iteration.radiosity) {
        whole = emission + *iteration.radiosity;
        told.radiosity = &whole;
      }
      return tell(told);
    };
  }
  RadiositySolution iterated = solve(stored, reflectance, source, solving);
  // in the place of the source, which is not needed any more
  source += reflectance.cwiseProduct(iterated.irradiance) - iterated.radiosity;
  iterated.report.relative_residual = largest_share(norms(mesh, source), emitted);
  for (Iteration& iteration : iterated.report.history) iteration.relative_residual *= relative;
  return iterated;
}

/// As many rays as the sample calls for, and no fewer than are stored.
int rays_needed_for(const PatchMesh& mesh, const GatheredLight& light, const RadiositySolution& iterated,
                    const GatherOptions& options) {
  const GatheredSolution& solution = light.solution;
  const GatherPlan& plan = solution.report.plan;
  const bool apart = plan.direct_apart;
  PatchField whole = iterated.irradiance;
  if (apart) whole += solution.direct;
  const Eigen::RowVectorXd level = norms(mesh, whole) / std::sqrt(total_area(mesh));
  const int needed = rays_needed(mesh, *light.rays, iterated.radiosity, level, options.fit && apart,
                                 plan.rays, options.accuracy);
  return std::max(needed, plan.stored_rays);
}

}  // namespace

GatheredLight gather_light(const PatchMesh& mesh, const RayScene& occluders, const PatchField& reflectance,
                           const PatchField& emission, const GatherOptions& options,
                           const SolveOptions& solving, const Progress& progress,
                           const std::function<void(GatherStage)>& on_stage) {
  if (reflectance.rows() != emission.rows() || reflectance.cols() != emission.cols()) {
    throw std::invalid_argument("solve_gathered: reflectance and emission differ in shape");
  }
  if (solving.bounces) throw std::invalid_argument("solve_gathered: cannot count bounces");
  GatheredLight light;
  GatheredSolution& solution = light.solution;
  GatherReport& report = solution.report;
  report.plan = gather_plan(mesh, emission, options);
  const bool apart = report.plan.direct_apart;

  // U = B - E starts from the direct light, B from the emission
  PatchField source = emission;
  if (apart) {
    DirectLight direct = direct_irradiance(mesh, occluders, emission, options, progress);
    report.shadow_rays = direct.rays;
    report.partly_lit = direct.partly_lit;
    solution.direct = std::move(direct.irradiance);
    source = reflectance.cwiseProduct(solution.direct);
  }
  light.rays = std::make_unique<GatherRays>(mesh, occluders, report.plan.rays, options.seed);
  GatherRays& rays = *light.rays;
  light.stored = stored_rays(rays, report.plan.stored_rays, mesh, progress);
  if (on_stage) on_stage(GatherStage::iteration);
  RadiositySolution iterated =
      iterate(mesh, *light.stored, reflectance, emission, std::move(source), apart, solving);
  if (on_stage) on_stage(GatherStage::rays);
  solution.light.report = std::move(iterated.report);

  PatchField& irradiance = solution.light.irradiance;
  report.rays = static_cast<std::int64_t>(mesh.size()) * report.plan.stored_rays;
  report.partial = solution.light.report.stopped == Stopped::caller;
  if (!report.partial) {
    if (!options.rays) report.plan.rays = rays_needed_for(mesh, light, iterated, options);
    const int known = rays.set_count(report.plan.rays) ? report.plan.stored_rays : 0;
    iterated.irradiance.resize(0, 0);
    try {
      GatheredField gathered =
          final_gather(mesh, rays, *light.stored, known, options.fit && apart, iterated.radiosity, progress);
      irradiance = std::move(gathered.values);
      solution.row_sums = std::move(gathered.row_sums);
      report.smoothed = gathered.smoothed;
      report.rays += static_cast<std::int64_t>(mesh.size()) * (report.plan.rays - known);
    } catch (const Cancelled&) {
      if (!options.keep_partial) throw;
      report.partial = true;
    }
  }
  if (report.partial) {
    irradiance.resize(emission.rows(), emission.cols());
    light.stored->apply(iterated.radiosity.data(), irradiance.data(), static_cast<int>(emission.cols()));
    solution.row_sums.assign(light.stored->row_sums().begin(), light.stored->row_sums().end());
  }
  if (apart) irradiance += solution.direct;
  solution.light.radiosity = emission + reflectance.cwiseProduct(irradiance);
  report.asked_twice = rays.asked_twice();
  report.bytes = light.stored->bytes() + rays.bytes();
  return light;
}

GatheredSolution solve_gathered(const PatchMesh& mesh, const RayScene& occluders,
                                const PatchField& reflectance, const PatchField& emission,
                                const GatherOptions& options, const SolveOptions& solving,
                                const Progress& progress) {
  return gather_light(mesh, occluders, reflectance, emission, options, solving, progress).solution;
}

}  // namespace luxel
