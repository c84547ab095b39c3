#include "luxel/operator_error.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "operator_error/coarse_exchange.h"
#include "operator_error/probe.h"
#include "operator_error/probed_error.h"
#include "operator_error/strata.h"
#include "sampling/owen_sobol.h"
#include "stage_progress.h"
#include "transport/gather/stored_rays.h"

namespace luxel {

namespace {

// Patches drawn from each stratum: errors seen on two of them are carried to the third, so that no noise is
// multiplied by itself.
constexpr int batches = 3;

// Strata: enough for an interval, and so many that more would narrow it by little.
constexpr int least_strata = 64, most_strata = 512;

// Parts between which errors are carried.
constexpr int most_parts = 64;

// Groups of strata that are left out in turn, and the quantile of Student's t for one less: 99.5 %, since
// squares of errors have long tails of which a sample often holds too little (docs/scale.md counts what
// holds).
constexpr int groups = 32;
constexpr double quantile = 2.74;

// What the probes themselves may be wrong by, relative to the irradiance: edges of patches in the map from
// hits to patches, lamps close by (up to 6e-4 among turned boxes of 600 patches).
constexpr double own_error = 5e-4;

// Rays of a look for which its noise is about the accuracy (docs/decisions/0010-gather.md): noise and number
// of probes are then in balance for the same rays in all.
constexpr double noise_at_one = 0.45, noise_order = 0.67;
constexpr int least_rays = 64, most_rays = 1 << 15;

// Rays stored for carrying errors where the operator has none.
constexpr int carrying_rays = 32;

constexpr std::uint64_t draw_stream = 0x64726177, look_stream = 0x6c6f6f6b;

/// What was found at one probe, m columns.
struct Defect {
  int patch = 0;
  std::array<Eigen::RowVectorXd, 2> halves;  // H - F B by two looks
  double row_sum = 0;
  std::int64_t rays = 0;

  Eigen::RowVectorXd mean() const { return (halves[0] + halves[1]) / 2; }
};

/// The mean square error over some strata, each channel, from the defects of all of them.
class MeanSquare {
 public:
  MeanSquare(const std::vector<std::array<Defect, batches>>& defects, const PatchField& reflectance,
             const CoarseExchange& coarse, const std::vector<double>& mean_reflectance, Eigen::Index channel)
      : defects_(defects), reflectance_(reflectance), coarse_(coarse), channel_(channel) {
    const auto parts = static_cast<Eigen::Index>(coarse.areas.size());
    Eigen::MatrixXd system = Eigen::MatrixXd::Identity(parts, parts);
    for (Eigen::Index j = 0; j < parts; ++j)
      system.col(j) -= coarse.form_factors.col(j) * mean_reflectance[j];
    solver_.compute(system);
  }

  /// @param left_out  one of the groups, or -1
  double operator()(int left_out) const {
    const auto parts = static_cast<Eigen::Index>(coarse_.areas.size());
    const int strata = static_cast<int>(defects_.size());
    const auto part = [&](int s) { return static_cast<Eigen::Index>(s) * parts / strata; };
    Eigen::MatrixXd source = Eigen::MatrixXd::Zero(parts, batches);
    Eigen::VectorXd counts = Eigen::VectorXd::Zero(parts);
    for (int s = 0; s < strata; ++s) {
      if (s % groups == left_out) continue;
      counts[part(s)] += 1;
      for (int b = 0; b < batches; ++b) {
        const Defect& defect = defects_[s][b];
        source(part(s), b) += reflectance_(defect.patch, channel_) * defect.mean()[channel_];
      }
    }
    for (Eigen::Index p = 0; p < parts; ++p) source.row(p) /= std::max(1.0, counts[p]);
    const Eigen::MatrixXd carried = solver_.solve(coarse_.form_factors * source);
    double sum = 0;
    int count = 0;
    for (int s = 0; s < strata; ++s) {
      if (s % groups == left_out) continue;
      for (int b = 0; b < batches; ++b) {
        const double first = defects_[s][b].halves[0][channel_], second = defects_[s][b].halves[1][channel_];
        const double x = carried(part(s), (b + 1) % batches), y = carried(part(s), (b + 2) % batches);
        sum += ((first + x) * (second + y) + (first + y) * (second + x)) / 2;
        ++count;
      }
    }
    return sum / count;
  }

 private:
  const std::vector<std::array<Defect, batches>>& defects_;
  const PatchField& reflectance_;
  const CoarseExchange& coarse_;
  Eigen::Index channel_;
  Eigen::PartialPivLU<Eigen::MatrixXd> solver_;
};

/// Sets estimate, low and high from a mean square and what it is without each group.
void set_interval(double square, const std::vector<double>& without, OperatorError& error) {
  const double count = static_cast<double>(without.size());
  double mean = 0, scatter = 0;
  for (const double x : without) mean += x / count;
  for (const double x : without) scatter += (x - mean) * (x - mean);
  const double reach = quantile * std::sqrt(scatter * (count - 1) / count);
  // squares scatter as their logarithms do: exp(reach / square) to second order, up to where it says nothing
  const double above = reach > 0 ? reach + reach * reach / (2 * std::max(square, reach)) : 0;
  error.estimate = std::sqrt(std::max(0.0, square));
  const double high = std::max(0.0, square) + above, low = square > reach ? square * square / high : 0;
  error.high = std::sqrt(high + own_error * own_error);
  error.low = std::sqrt(std::max(0.0, low - own_error * own_error));
}

// Looks at each of a stratum's patches: two, and as many rays again for lamps.
constexpr double rays_a_stratum = 2.0 * batches * 2;

// As the accuracy calls for, if the least strata can have so many; more where all strata can.
int rays_of_looks(const OperatorErrorOptions& options) {
  const double wanted = std::pow(noise_at_one / options.accuracy, 1 / noise_order);
  const double affordable = options.most_rays / (rays_a_stratum * least_strata);
  const double left = options.most_rays / (rays_a_stratum * most_strata);
  return static_cast<int>(
      std::clamp<double>(std::max(std::min(wanted, affordable), left), least_rays, most_rays));
}

void require(bool holds, const char* message) {
  if (!holds) throw std::invalid_argument(std::string("operator_error: ") + message);
}

}  // namespace

OperatorError probed_error(const PatchMesh& mesh, const RayScene& occluders, const GatherRays& rays,
                           const GatherOperator& stored, const PatchField& reflectance,
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
  OperatorError error;
  if (size == 0 || solution.irradiance.cols() == 0) return error;

  const int look_rays = rays_of_looks(options);
  const double affordable = options.most_rays / (rays_a_stratum * look_rays);
  const int count = static_cast<int>(std::clamp<double>(affordable, least_strata, most_strata));
  const Strata strata(rays.packets(), mesh.areas, count);
  const Probe probe(mesh, occluders, rays, emission, solution.radiosity, look_rays);

  std::vector<std::array<Defect, batches>> defects(count);
  StageProgress stage(progress, "error bar", count);
  tbb::parallel_for(tbb::blocked_range<int>(0, count, 1), [&](const tbb::blocked_range<int>& range) {
    if (stage.cancelled()) return;
    for (int s = range.begin(); s < range.end(); ++s) {
      for (int b = 0; b < batches; ++b) {
        Defect& defect = defects[s][b];
        defect.patch = strata.draw(s, mixed_seed(options.seed ^ draw_stream, b));
        for (int half = 0; half < 2; ++half) {
          const std::uint64_t place = (static_cast<std::uint64_t>(s) * batches + b) * 2 + half;
          const Probe::Look look = probe.look(defect.patch, mixed_seed(options.seed ^ look_stream, place));
          defect.halves[half] = solution.irradiance.row(defect.patch) - look.irradiance;
          defect.row_sum += look.row_sum / 2;
          defect.rays += look.rays;
        }
      }
    }
    stage.add(range.size());
  });
  stage.finish();

  double row_squares = 0;
  for (const auto& of_stratum : defects) {
    for (const Defect& defect : of_stratum) {
      error.rays += defect.rays;
      ++error.probes;
      if (row_sums.empty()) continue;
      const double off = std::abs(row_sums[defect.patch] - defect.row_sum);
      error.row_sum_error_max = std::max(error.row_sum_error_max, off);
      row_squares += off * off;
    }
  }
  error.row_sum_error_rms = std::sqrt(row_squares / error.probes);

  const int parts = std::min(most_parts, count);
  std::vector<std::int32_t> part = strata.of_patch();
  for (std::int32_t& p : part) p = static_cast<std::int32_t>(static_cast<std::int64_t>(p) * parts / count);
  const CoarseExchange coarse = coarse_exchange(stored, part, parts);
  const Eigen::Map<const Eigen::RowVectorXd> areas(mesh.areas.data(), size);
  double worst = -1;
  for (Eigen::Index c = 0; c < solution.irradiance.cols(); ++c) {
    const double whole = areas.dot(solution.irradiance.col(c).cwiseAbs2()) / areas.sum();
    if (!(whole > 0)) continue;
    std::vector<double> mean_reflectance(parts, 0.0), part_areas(parts, 0.0);
    for (int i = 0; i < size; ++i) {
      mean_reflectance[part[i]] += mesh.areas[i] * reflectance(i, c);
      part_areas[part[i]] += mesh.areas[i];
    }
    for (int p = 0; p < parts; ++p) {
      if (part_areas[p] > 0) mean_reflectance[p] /= part_areas[p];
    }
    const MeanSquare mean_square(defects, reflectance, coarse, mean_reflectance, c);
    std::vector<double> without;
    for (int g = 0; g < groups; ++g) without.push_back(mean_square(g) / whole);
    OperatorError of_channel = error;
    set_interval(mean_square(-1) / whole, without, of_channel);
    if (!(of_channel.high > worst)) continue;
    worst = of_channel.high;
    error = of_channel;
  }
  return error;
}

OperatorError operator_error(const PatchMesh& mesh, const RayScene& occluders, const PatchField& reflectance,
                             const PatchField& emission, const RadiositySolution& solution,
                             std::span<const double> row_sums, const OperatorErrorOptions& options,
                             const Progress& progress) {
  const GatherRays rays(mesh, occluders, carrying_rays, mixed_seed(options.seed, look_stream),
                        rays_of_looks(options));
  const auto stored = stored_rays(rays, carrying_rays, mesh, {});
  return probed_error(mesh, occluders, rays, *stored, reflectance, emission, solution, row_sums, options,
                      progress);
}

}  // namespace luxel
