#include "transport/hierarchical/coarse_operator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "luxel/vector.h"

namespace luxel {

CoarseOperator::CoarseOperator(BlockProduct product, std::vector<double> areas)
    : product_(std::move(product)), areas_(std::move(areas)), row_sums_(areas_.size()) {
  const std::vector<double> ones(areas_.size(), 1.0);
  apply(ones.data(), row_sums_.data(), 1);
}

void CoarseOperator::close(std::vector<double> factors, const std::vector<char>& closed) {
  factors_ = std::move(factors);
  const auto [least, most] = std::minmax_element(factors_.begin(), factors_.end());
  largest_correction_ = std::max(std::abs(*least * *least - 1), std::abs(*most * *most - 1));
  const std::vector<double> ones(areas_.size(), 1.0);
  apply(ones.data(), row_sums_.data(), 1);
  diagonal_.assign(areas_.size(), 0.0);
  for (std::size_t i = 0; i < closed.size(); ++i) {
    if (!closed[i]) continue;
    diagonal_[i] = 1 - row_sums_[i];
    row_sums_[i] = 1;
  }
}

void CoarseOperator::apply(const double* x, double* y, int columns) const {
  if (factors_.empty()) {
    product_.apply(x, y, columns);
    return;
  }
  const Eigen::Index size = static_cast<Eigen::Index>(areas_.size());
  const Eigen::Map<const PatchField> from(x, size, columns);
  const Eigen::Map<const Eigen::VectorXd> factors(factors_.data(), size);
  Eigen::Map<PatchField> to(y, size, columns);
  const PatchField scaled = factors.asDiagonal() * from;
  product_.apply(scaled.data(), y, columns);
  to = factors.asDiagonal() * to;
  if (diagonal_.empty()) return;
  to += Eigen::Map<const Eigen::VectorXd>(diagonal_.data(), size).asDiagonal() * from;
}

std::size_t CoarseOperator::bytes() const {
  return product_.bytes() +
         (areas_.size() + row_sums_.size() + factors_.size() + diagonal_.size()) * sizeof(double);
}

}  // namespace luxel
