#include "luxel/operator_error.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "operator_error/coarse_exchange.h"
#include "operator_error/defect.h"
#include "operator_error/interval.h"
#include "operator_error/mean_square.h"
#include "operator_error/probe.h"
#include "operator_error/strata.h"
#include "sampling/owen_sobol.h"
#include "stage_progress.h"
#include "transport/gather/packets.h"

namespace luxel {

namespace {

// Strata: enough for an interval, and so many that more would narrow it by little.
constexpr int least_strata = 64, most_strata = 1024;

// Parts between which errors are carried, and rays that shall meet one from another.
constexpr int most_parts = 64;
constexpr double rays_a_pair_of_parts = 64;

// Of the measure by which patches are drawn: what goes by area alone. The rest goes by area times irradiance
// squared, as errors do that are relative ones; no weight is above the inverse of this.
constexpr double share_by_area = 0.5;

// Rays of a look for which its noise is about the accuracy (docs/decisions/0015-operator-error-bar.md): noise
// and number of probes are then in balance for the same rays in all.
constexpr double noise_at_one = 0.45, noise_order = 0.67;
constexpr int least_rays = 64, most_rays = 1 << 15;

constexpr std::uint64_t draw_stream = 0x64726177, look_stream = 0x6c6f6f6b;

// Looks at each of a stratum's patches: two, and as many rays again for lamps.
constexpr double rays_a_stratum = 2.0 * batches * 2;

/// As the accuracy calls for, if the least strata can have so many.
int rays_of_looks(const OperatorErrorOptions& options) {
  const double wanted = std::pow(noise_at_one / options.accuracy, 1 / noise_order);
  const double affordable = options.most_rays / (rays_a_stratum * least_strata);
  return static_cast<int>(std::clamp<double>(std::min(wanted, affordable), least_rays, most_rays));
}

void require(bool holds, const char* message) {
  if (!holds) throw std::invalid_argument(std::string("operator_error: ") + message);
}

/// Mean of squares over the surface, each channel.
Eigen::RowVectorXd mean_squares(const PatchField& field, const std::vector<double>& areas) {
  const Eigen::Map<const Eigen::RowVectorXd> weights(areas.data(), static_cast<Eigen::Index>(areas.size()));
  Eigen::RowVectorXd means(field.cols());
  for (Eigen::Index c = 0; c < field.cols(); ++c) {
    means[c] = weights.dot(field.col(c).cwiseAbs2()) / weights.sum();
  }
  return means;
}

/// By what patches are drawn.
std::vector<double> measures_of(const PatchMesh& mesh, const PatchField& irradiance,
                                const Eigen::RowVectorXd& whole) {
  const auto lit = static_cast<double>((whole.array() > 0).count());
  std::vector<double> measures(mesh.areas);
  if (lit == 0) return measures;
  const Eigen::RowVectorXd inverse = (whole.array() > 0).select(whole.cwiseInverse(), 0.0) / lit;
  for (int i = 0; i < mesh.size(); ++i) {
    const double relative = irradiance.row(i).cwiseAbs2().dot(inverse);
    measures[i] *= share_by_area + (1 - share_by_area) * relative;
  }
  return measures;
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

std::vector<double> mean_reflectances(const PatchMesh& mesh, const std::vector<std::int32_t>& part, int parts,
                                      const PatchField& reflectance, Eigen::Index channel) {
  std::vector<double> means(parts, 0.0), areas(parts, 0.0);
  for (int i = 0; i < mesh.size(); ++i) {
    means[part[i]] += mesh.areas[i] * reflectance(i, channel);
    areas[part[i]] += mesh.areas[i];
  }
  for (int p = 0; p < parts; ++p) {
    if (areas[p] > 0) means[p] /= areas[p];
  }
  return means;
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

  const int look_rays = rays_of_looks(options);
  const double affordable = options.most_rays / (rays_a_stratum * look_rays);
  const int count = static_cast<int>(std::clamp<double>(affordable, least_strata, most_strata));
  const double met = rays_a_stratum / 2 * count * look_rays;
  const int parts = std::min({most_parts, count, static_cast<int>(std::sqrt(met / rays_a_pair_of_parts))});
  const Eigen::RowVectorXd whole = mean_squares(solution.irradiance, mesh.areas);
  const std::vector<double> measures = measures_of(mesh, solution.irradiance, whole);
  const Strata strata(packets_of(mesh), measures, count);
  std::vector<std::int32_t> part = strata.of_patch();
  for (std::int32_t& p : part) p = static_cast<std::int32_t>(static_cast<std::int64_t>(p) * parts / count);
  const Probe probe(mesh, occluders, emission, solution.radiosity, strata.order(), part, parts, look_rays);

  std::vector<StratumDefects> defects(count);
  StageProgress stage(progress, "error bar", count);
  tbb::parallel_for(tbb::blocked_range<int>(0, count, 1), [&](const tbb::blocked_range<int>& range) {
    if (stage.cancelled()) return;
    for (int s = range.begin(); s < range.end(); ++s) {
      for (int b = 0; b < batches; ++b) {
        Defect& defect = defects[s][b];
        defect.patch = strata.draw(s, mixed_seed(options.seed ^ draw_stream, b));
        defect.weight = mesh.areas[defect.patch] / measures[defect.patch];
        defect.met.assign(parts, 0);
        for (int half = 0; half < 2; ++half) {
          const std::uint64_t place = (static_cast<std::uint64_t>(s) * batches + b) * 2 + half;
          const Probe::Look look = probe.look(defect.patch, mixed_seed(options.seed ^ look_stream, place));
          defect.halves[half] = solution.irradiance.row(defect.patch) - look.irradiance;
          for (int p = 0; p < parts; ++p) defect.met[p] += look.met[p];
          defect.row_sum += look.row_sum / 2;
          defect.rays += look.rays;
        }
      }
    }
    stage.add(range.size());
  });
  stage.finish();

  OperatorError error = counted(defects, row_sums);
  const CoarseExchange coarse = coarse_exchange(defects, part, parts, 2 * look_rays);
  double worst = -1;
  for (Eigen::Index c = 0; c < solution.irradiance.cols(); ++c) {
    if (!(whole[c] > 0)) continue;
    const MeanSquare mean_square(defects, reflectance, coarse,
                                 mean_reflectances(mesh, part, parts, reflectance, c), c);
    std::vector<double> without;
    for (int g = 0; g < MeanSquare::groups; ++g) without.push_back(mean_square(g) / whole[c]);
    const Interval interval =
        error_interval(mean_square(-1) / whole[c], without, mean_square.noise() / whole[c]);
    if (!(interval.high > worst)) continue;
    worst = interval.high;
    error.estimate = interval.estimate;
    error.low = interval.low;
    error.high = interval.high;
  }
  return error;
}

}  // namespace luxel
