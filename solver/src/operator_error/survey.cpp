#include "operator_error/survey.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "operator_error/coarse_exchange.h"
#include "operator_error/mean_square.h"
#include "ordered_sum.h"
#include "sampling/owen_sobol.h"
#include "stage_progress.h"
#include "transport/gather/packets.h"

namespace luxel {

namespace {

// Of the measure by which patches are drawn: what goes by area alone. The rest goes by area times irradiance
// squared, as errors do that are relative ones; no weight is above the inverse of this (Hesterberg 1995,
// defensive mixtures).
constexpr double share_by_area = 0.5;

constexpr std::uint64_t draw_stream = 0x64726177, look_stream = 0x6c6f6f6b;

/// Mean of squares over the surface, each channel.
Eigen::RowVectorXd mean_squares(const PatchField& field, const std::vector<double>& areas) {
  const Eigen::Map<const Eigen::RowVectorXd> weights(areas.data(), static_cast<Eigen::Index>(areas.size()));
  Eigen::RowVectorXd means(field.cols());
  for (Eigen::Index c = 0; c < field.cols(); ++c) {
    means[c] = weights.dot(field.col(c).cwiseAbs2()) / ordered_sum(areas);
  }
  return means;
}

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

Survey::Survey(const PatchMesh& mesh, const RayScene& occluders, const PatchField& reflectance,
               const PatchField& emission, const RadiositySolution& solution, int parts)
    : mesh_(mesh),
      reflectance_(reflectance),
      solution_(solution),
      parts_(parts),
      whole_(mean_squares(solution.irradiance, mesh.areas)),
      measures_(measures_of(mesh, solution.irradiance, whole_)),
      strata_(packets_of(mesh), measures_),
      part_(strata_.of_patch(parts)),
      probe_(mesh, occluders, emission, solution.radiosity, strata_.order(), part_, parts) {}

std::vector<StratumDefects> Survey::defects(int strata, int rays, std::uint64_t seed,
                                            const Progress& progress) const {
  std::vector<StratumDefects> defects(strata);
  StageProgress stage(progress, "error bar", strata);
  tbb::parallel_for(tbb::blocked_range<int>(0, strata, 1), [&](const tbb::blocked_range<int>& range) {
    if (stage.cancelled()) return;
    for (int s = range.begin(); s < range.end(); ++s) {
      for (int b = 0; b < batches; ++b) {
        Defect& defect = defects[s][b];
        defect.patch = strata_.draw(s, strata, mixed_seed(seed ^ draw_stream, b));
        defect.weight = mesh_.areas[defect.patch] / measures_[defect.patch];
        defect.met.assign(parts_, 0);
        for (int half = 0; half < 2; ++half) {
          const std::uint64_t place = (static_cast<std::uint64_t>(s) * batches + b) * 2 + half;
          const Probe::Look look = probe_.look(defect.patch, rays, mixed_seed(seed ^ look_stream, place));
          defect.halves[half] = solution_.irradiance.row(defect.patch) - look.irradiance;
          for (int p = 0; p < parts_; ++p) defect.met[p] += look.met[p];
          defect.row_sum += look.row_sum / 2;
          defect.looked += rays;
          defect.rays += look.rays;
        }
      }
    }
    stage.add(range.size());
  });
  stage.finish();
  return defects;
}

Survey::Finding Survey::finding(const std::vector<StratumDefects>& defects) const {
  const CoarseExchange coarse = coarse_exchange(defects, part_, parts_);
  Finding worst;
  for (Eigen::Index c = 0; c < whole_.size(); ++c) {
    if (!(whole_[c] > 0)) continue;
    const MeanSquare mean_square(defects, reflectance_, coarse,
                                 mean_reflectances(mesh_, part_, parts_, reflectance_, c), c);
    std::vector<double> without;
    for (int g = 0; g < MeanSquare::groups; ++g) without.push_back(mean_square(g) / whole_[c]);
    const double noise = mean_square.noise() / whole_[c];
    const Interval interval = error_interval(mean_square(-1) / whole_[c], without, noise);
    if (!(interval.high > worst.interval.high)) continue;
    worst = {interval, mean_square.noise_of_look() / whole_[c], noise};
  }
  return worst;
}

}  // namespace luxel
