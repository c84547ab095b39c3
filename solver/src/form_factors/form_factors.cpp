#include "luxel/form_factors.h"

#include <stdexcept>

#include "form_factors/assembly.h"
#include "form_factors/sky_box.h"

namespace luxel {

namespace {

// What each patch exchanges with the sky, as a share; and the matrix without it.
std::vector<double> split_off_sky(const PatchMesh& mesh, ExchangeMatrix& exchange_areas) {
  std::vector<double> shares(static_cast<std::size_t>(mesh.size()));
  for (int sky = mesh.size(); sky < exchange_areas.size(); ++sky) {
    for (int i = 0; i < mesh.size(); ++i) shares[i] += exchange_areas(sky, i) / mesh.areas[i];
  }
  exchange_areas.keep_first(mesh.size());
  return shares;
}

FormFactors with_sky(const PatchMesh& mesh, const FormFactorOptions& options, const Progress& progress) {
  const PatchMesh boxed = in_sky_box(mesh);
  ClusterTree tree = cluster_tree(boxed);
  tree.sky_begin = mesh.size();
  FormFactors result{ExchangeMatrix(boxed.size(), options.precision), {}, {}};
  fill_unoccluded(tree, options.accuracy, result.exchange_areas, result.report, progress);
  for (int i = mesh.size(); i < boxed.size(); ++i) {
    for (int j = mesh.size(); j < i; ++j) result.exchange_areas.set(i, j, 0);
  }
  subtract_hidden(boxed, tree, options, result.exchange_areas, result.report, progress);
  result.sky_shares = split_off_sky(mesh, result.exchange_areas);
  result.report.pairs = static_cast<std::int64_t>(mesh.size()) * (mesh.size() - 1) / 2;
  return result;
}

}  // namespace

FormFactors form_factors(const PatchMesh& mesh, const FormFactorOptions& options, const Progress& progress) {
  if (!(options.accuracy >= 1e-8 && options.accuracy <= 0.1)) {
    throw std::invalid_argument("accuracy of form factors must be in [1e-8, 0.1], not " +
                                std::to_string(options.accuracy));
  }
  if (options.sky_shares) return with_sky(mesh, options, progress);
  const ClusterTree tree = cluster_tree(mesh);
  FormFactors result{ExchangeMatrix(mesh.size(), options.precision), {}, {}};
  fill_unoccluded(tree, options.accuracy, result.exchange_areas, result.report, progress);
  subtract_hidden(mesh, tree, options, result.exchange_areas, result.report, progress);
  return result;
}

}  // namespace luxel
