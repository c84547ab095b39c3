#include "plan/with_dark.h"

#include <limits>
#include <utility>

namespace luxel {

namespace {

/// 0 in the dark.
PatchField whole_field(const PatchField& part, const DarkEnclosures& dark) {
  PatchField whole = PatchField::Zero(static_cast<Eigen::Index>(dark.enclosure.size()), part.cols());
  whole(dark.others, Eigen::all) = part;
  return whole;
}

}  // namespace

PlanOptions told_of_all(PlanOptions options, const DarkEnclosures& dark) {
  if (!options.solve.on_iteration) return options;
  options.solve.on_iteration = [&dark, tell = options.solve.on_iteration](const Iteration& iteration) {
    Iteration told = iteration;
    PatchField whole;
    if (iteration.radiosity) {
      whole = whole_field(*iteration.radiosity, dark);
      told.radiosity = &whole;
    }
    return tell(told);
  };
  return options;
}

PlannedSolution light_of_none() {
  constexpr int channels = 3;
  PlannedSolution light;
  light.solution.radiosity = light.solution.irradiance = PatchField::Zero(0, channels);
  light.solution.report.method = Method::neumann;
  light.solution.report.converged = true;
  light.solution.report.error_bound = 0;
  light.energy.emitted = light.energy.absorbed = light.energy.escaped = Eigen::RowVectorXd::Zero(channels);
  return light;
}

void add_dark(PlannedSolution& light, const DarkEnclosures& dark) {
  light.solution.radiosity = whole_field(light.solution.radiosity, dark);
  light.solution.irradiance = whole_field(light.solution.irradiance, dark);
  std::vector<double> row_sums(dark.enclosure.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = 0; k < light.row_sums.size(); ++k) row_sums[dark.others[k]] = light.row_sums[k];
  light.row_sums = std::move(row_sums);
  ClosureReport& closure = light.closure;
  if (closure.unclosed >= 0) {
    closure.unclosed = dark.others[closure.unclosed];
    closure.message = unclosed_message(closure.unclosed);
  }
}

SingularSystem singular_among_all(const SingularSystem& singular, const DarkEnclosures& dark) {
  return {dark.others[singular.patch()], singular.channel(), singular.emits()};
}

Enclosures with_dark(const Enclosures& others, const DarkEnclosures& dark) {
  Enclosures whole;
  whole.closed = others.closed || dark.others.empty();
  whole.rays = others.rays;
  std::vector<int> of_dark(dark.count, -1), of_other(others.count, -1);
  const bool rays_known = dark.others.empty() || !others.share_rays.empty();
  std::size_t next = 0;
  for (const int e : dark.enclosure) {
    const bool is_dark = e >= 0;
    const std::size_t k = is_dark ? next : next++;
    int& place = is_dark ? of_dark[e] : of_other[others.enclosure[k]];
    if (place < 0) {
      place = whole.count++;
      whole.enclosure_closed.push_back(is_dark ? 1 : others.enclosure_closed[others.enclosure[k]]);
    }
    whole.enclosure.push_back(place);
    whole.open_share.push_back(is_dark ? 0 : others.open_share[k]);
    whole.back_share.push_back(is_dark ? 0 : others.back_share[k]);
    whole.share_error.push_back(is_dark ? 0 : others.share_error[k]);
    if (rays_known) whole.share_rays.push_back(is_dark ? 0 : others.share_rays[k]);
  }
  return whole;
}

}  // namespace luxel
