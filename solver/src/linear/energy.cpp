#include <algorithm>
#include <cmath>

#include "linear/columns.h"
#include "luxel/solve.h"

namespace luxel {

Energy energy(const TransportOperator& transport, const PatchField& reflectance, const PatchField& emission,
              const RadiositySolution& solution) {
  const Eigen::Index n = transport.size();
  const Eigen::Map<const Eigen::VectorXd> areas(transport.areas().data(), n);
  const Eigen::Map<const Eigen::VectorXd> row_sums(transport.row_sums().data(), n);
  const Eigen::VectorXd open = Eigen::VectorXd::Ones(n) - row_sums;
  const PatchField ones = PatchField::Ones(n, emission.cols());
  Energy energy;
  energy.emitted = weighted_dots(areas, emission, ones);
  energy.absorbed = weighted_dots(areas, solution.irradiance, ones - reflectance);
  energy.escaped = weighted_dots(areas, solution.radiosity, open.replicate(1, emission.cols()));
  for (Eigen::Index c = 0; c < emission.cols(); ++c) {
    if (energy.emitted[c] == 0) continue;
    const double missing = std::abs(energy.emitted[c] - energy.absorbed[c] - energy.escaped[c]);
    energy.imbalance = std::max(energy.imbalance, missing / energy.emitted[c]);
  }
  return energy;
}

}  // namespace luxel
