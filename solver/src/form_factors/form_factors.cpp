#include "luxel/form_factors.h"

#include <stdexcept>

#include "form_factors/assembly.h"

namespace luxel {

FormFactors form_factors(const PatchMesh& mesh, const FormFactorOptions& options, const Progress& progress) {
  if (!(options.accuracy >= 1e-8 && options.accuracy <= 0.1)) {
    throw std::invalid_argument("accuracy of form factors must be in [1e-8, 0.1], not " +
                                std::to_string(options.accuracy));
  }
  const ClusterTree tree = cluster_tree(mesh);
  FormFactors result{ExchangeMatrix(mesh.size(), options.precision), {}};
  fill_unoccluded(tree, options.accuracy, result.exchange_areas, result.report, progress);
  return result;
}

}  // namespace luxel
