#include "transport/hierarchical/brightness.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "luxel/solve.h"
#include "ordered_sum.h"

namespace luxel {

namespace {

// Nothing counts as darker than this share of the mean: rows must be right in shadows too, where other light
// may go.
constexpr double darkest_share = 0.6;

// Bounces that tell where the light goes, and the most that a coarse operator, whose rows may exceed 1, is
// let reflect.
constexpr int bounces = 12;
constexpr double most_reflected = 0.95;

constexpr std::size_t patches_a_task = 16384;

template <class Body>
void for_patches(std::size_t count, const Body& body) {
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, count, patches_a_task),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t k = range.begin(); k < range.end(); ++k) body(k);
      },
      tbb::simple_partitioner());
}

// Means of the clusters from those of the patches by position.
Brightness with_clusters(const PatchHierarchy& hierarchy, std::vector<float> patches) {
  const PatchMesh& mesh = *hierarchy.mesh;
  Brightness brightness{std::vector<float>(hierarchy.clusters.size()), std::move(patches)};
  for (int c = hierarchy.cluster_count() - 1; c >= 0; --c) {
    const PatchCluster& cluster = hierarchy.clusters[c];
    double light = 0, area = 0;
    for (int k = 0; k < cluster.child_count; ++k) {
      const int child = cluster.children[k];
      const double size = hierarchy.single(child) ? mesh.areas[hierarchy.patch(child)] *
                                                        hierarchy.frame.scale * hierarchy.frame.scale
                                                  : hierarchy.clusters[child].area;
      light += size * brightness(hierarchy, child);
      area += size;
    }
    brightness.clusters[c] = static_cast<float>(light / area);
  }
  return brightness;
}

// The brightest channel of each patch, each as a multiple of its irradiance; channels without light do not
// count.
Brightness brightest(const PatchHierarchy& hierarchy, const PatchField& radiosity,
                     const Eigen::RowVectorXd& irradiance) {
  Eigen::RowVectorXd weights(irradiance.size());
  for (Eigen::Index c = 0; c < weights.size(); ++c) weights[c] = irradiance[c] > 0 ? 1 / irradiance[c] : 0;
  if (!(weights.size() > 0 && weights.maxCoeff() > 0)) return uniform_brightness(hierarchy);
  const PatchMesh& mesh = *hierarchy.mesh;
  std::vector<float> by_patch(hierarchy.order.size()), patches(by_patch.size());
  for_patches(by_patch.size(), [&](std::size_t p) {
    const double* row = radiosity.data() + p * weights.size();
    double most = 0;
    for (Eigen::Index c = 0; c < weights.size(); ++c) most = std::max(most, row[c] * weights[c]);
    by_patch[p] = static_cast<float>(most);
  });
  double mean = 0, total = 0;
  for (std::size_t p = 0; p < by_patch.size(); ++p) {
    mean += mesh.areas[p] * by_patch[p];
    total += mesh.areas[p];
  }
  const auto floor = static_cast<float>(total > 0 ? darkest_share * mean / total : 0);
  for_patches(patches.size(),
              [&](std::size_t k) { patches[k] = std::max(by_patch[hierarchy.order[k]], floor); });
  return with_clusters(hierarchy, std::move(patches));
}

}  // namespace

Brightness uniform_brightness(const PatchHierarchy& hierarchy) {
  return {std::vector<float>(hierarchy.clusters.size(), 1.0F),
          std::vector<float>(hierarchy.order.size(), 1.0F)};
}

Brightness guessed_brightness(const PatchHierarchy& hierarchy, const PatchField& reflectance,
                              const PatchField& emission) {
  const Eigen::Map<const Eigen::RowVectorXd> areas(hierarchy.mesh->areas.data(), hierarchy.mesh->size());
  const Eigen::RowVectorXd emitted = areas * emission, reflected = areas * reflectance;
  const double area = ordered_sum(hierarchy.mesh->areas);
  // the integrating sphere
  Eigen::RowVectorXd irradiance(emitted.size());
  for (Eigen::Index c = 0; c < emitted.size(); ++c) {
    irradiance[c] = emitted[c] / (area - std::min(reflected[c], most_reflected * area));
  }
  const PatchField radiosity = emission + reflectance * irradiance.asDiagonal();
  return brightest(hierarchy, radiosity, irradiance);
}

Brightness solved_brightness(const PatchHierarchy& hierarchy, const NodeInterpolation& interpolation,
                             const TransportOperator& coarse, const PatchField& reflectance,
                             const PatchField& emission) {
  const int columns = static_cast<int>(emission.cols());
  PatchField rho(interpolation.unknowns(), columns), source = rho;
  interpolation.to_nodes(reflectance.data(), rho.data(), columns);
  interpolation.to_nodes(emission.data(), source.data(), columns);
  for (Eigen::Index i = 0; i < rho.rows(); ++i) {
    const double most = most_reflected / std::max(1.0, coarse.row_sums()[i]);
    rho.row(i) = rho.row(i).cwiseMax(0).cwiseMin(most);
  }
  SolveOptions options;
  options.bounces = bounces;
  const RadiositySolution solution = solve(coarse, rho, source.cwiseMax(0), options);
  const Eigen::Map<const Eigen::VectorXd> areas(coarse.areas().data(), coarse.size());
  Eigen::RowVectorXd irradiance =
      (areas.transpose() * solution.irradiance.cwiseAbs2() / ordered_sum(coarse.areas())).cwiseSqrt();
  PatchField radiosity(interpolation.patches(), columns);
  interpolation.to_patches(solution.radiosity.data(), radiosity.data(), columns);
  return brightest(hierarchy, radiosity, irradiance);
}

}  // namespace luxel
