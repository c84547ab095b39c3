#include "luxel/operator_error.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "operator_error/survey.h"
#include "sampling/owen_sobol.h"

namespace luxel {

namespace {

// Parts of the scene between which errors are carried: so many that rays from each meet most others. Strata
// come in multiples of them: enough for an interval, and so many that more would narrow it by little.
constexpr int parts = 64, most_strata = 1024;

// Rays of a look for which its noise is about the accuracy (docs/decisions/0015-operator-error-bar.md), the
// start of the search for their number.
constexpr double noise_at_one = 0.45, noise_order = 0.67;
constexpr int least_rays = 64, most_rays = 1 << 15;

// Looks at each of a stratum's patches: two, and as many rays again for lamps.
constexpr double rays_a_stratum = 2.0 * batches * 2;

// Where the rays suffice for so many times the least strata, those are looked at first, to learn how large
// the error is. For the least scatter from rays that are given, the mean square noise of a look is then to be
// twice the mean square error: 1.1 times if errors scatter as normal ones do, more if a few patches hold
// most.
constexpr int worth_a_pilot = 4;
constexpr double best_noise = 2;
constexpr std::uint64_t pilot_stream = 0x70696c6f;

/// As the accuracy calls for, if the least strata can have so many.
int first_rays(const OperatorErrorOptions& options) {
  const double wanted = std::pow(noise_at_one / options.accuracy, 1 / noise_order);
  const double affordable = options.most_rays / (rays_a_stratum * parts);
  return static_cast<int>(std::clamp<double>(std::min(wanted, affordable), least_rays, most_rays));
}

/// More where the pilot saw, or could see, a smaller error. Its outliers are no reason for fewer.
int next_rays(const Survey::Finding& pilot, int rays, double affordable) {
  const double square = std::max(pilot.interval.estimate * pilot.interval.estimate, pilot.noise);
  if (!(square > 0)) return rays;
  const double wanted = rays * std::pow(pilot.noise_of_look / (best_noise * square), 0.5 / noise_order);
  return std::max(rays, static_cast<int>(std::min({wanted, affordable, double{most_rays}})));
}

void require(bool holds, const char* message) {
  if (!holds) throw std::invalid_argument(std::string("operator_error: ") + message);
}

/// Row sums given against those of the probes, and what was cast.
OperatorError counted(const std::vector<StratumDefects>& defects, std::span<const double> row_sums) {
  OperatorError error;
  double squares = 0, whole = 0;
  for (const StratumDefects& of_stratum : defects) {
    for (const Defect& defect : of_stratum) {
      error.rays += defect.rays;
      ++error.probes;
      if (row_sums.empty()) continue;
      const double off = std::abs(row_sums[defect.patch] - defect.row_sum);
      error.row_sum_error_max = std::max(error.row_sum_error_max, off);
      squares += defect.weight * off * off;
      whole += defect.weight;
    }
  }
  if (whole > 0) error.row_sum_error_rms = std::sqrt(squares / whole);
  return error;
}

}  // namespace

OperatorError operator_error(const PatchMesh& mesh, const RayScene& occluders, const PatchField& reflectance,
                             const PatchField& emission, const RadiositySolution& solution,
                             std::span<const double> row_sums, const OperatorErrorOptions& options,
                             const Progress& progress) {
  const int size = mesh.size();
  require(reflectance.rows() == size && emission.rows() == size && solution.radiosity.rows() == size &&
              solution.irradiance.rows() == size &&
              (row_sums.empty() || static_cast<int>(row_sums.size()) == size),
          "needs fields of one row for each patch");
  require(options.accuracy > 0 && options.accuracy < 1 && options.most_rays >= 0,
          "accuracy or rays out of range");
  if (size == 0 || solution.irradiance.cols() == 0) return {};

  const Survey survey(mesh, occluders, reflectance, emission, solution, parts);
  int rays = first_rays(options);
  double left = options.most_rays;
  std::int64_t cast = 0;
  if (left >= worth_a_pilot * rays_a_stratum * parts * rays) {
    const auto pilot = survey.defects(parts, rays, mixed_seed(options.seed, pilot_stream), progress);
    cast = counted(pilot, {}).rays;
    left -= static_cast<double>(cast);
    rays = next_rays(survey.finding(pilot), rays, left / (rays_a_stratum * parts));
  }
  const double affordable = left / (rays_a_stratum * rays * parts);
  const int strata = parts * static_cast<int>(std::clamp<double>(affordable, 1, most_strata / parts));
  const auto defects = survey.defects(strata, rays, options.seed, progress);
  OperatorError error = counted(defects, row_sums);
  error.rays += cast;
  const Interval interval = survey.finding(defects).interval;
  error.estimate = interval.estimate;
  error.low = interval.low;
  error.high = interval.high;
  return error;
}

}  // namespace luxel
