#include "luxel/dense_operator.h"

#include <stdexcept>
#include <utility>

#include "transport/symmetric_product.h"

namespace luxel {

DenseOperator::DenseOperator(ExchangeMatrix exchange_areas, std::vector<double> areas)
    : DenseOperator(std::move(exchange_areas), std::move(areas), {}) {}

DenseOperator::DenseOperator(ExchangeMatrix exchange_areas, std::vector<double> areas,
                             std::vector<double> diagonal)
    : exchange_(std::move(exchange_areas)), areas_(std::move(areas)), diagonal_(std::move(diagonal)) {
  const std::size_t size = exchange_.size();
  if (diagonal_.empty()) diagonal_.assign(size, 0.0);
  if (areas_.size() != size || diagonal_.size() != size) {
    throw std::invalid_argument("DenseOperator: areas and diagonal need one number for each patch");
  }
  for (double area : areas_) {
    if (!(area > 0)) throw std::invalid_argument("DenseOperator: every area must be above 0");
  }
  row_sums_.resize(size);
  const std::vector<double> ones(size, 1.0);
  apply(ones.data(), row_sums_.data(), 1);
}

void DenseOperator::apply(const double* x, double* y, int columns) const {
  symmetric_product(exchange_, x, y, columns);
  for (int i = 0; i < size(); ++i) {
    for (int c = 0; c < columns; ++c) {
      const std::size_t k = static_cast<std::size_t>(i) * columns + c;
      y[k] = (y[k] + diagonal_[i] * x[k]) / areas_[i];
    }
  }
}

std::size_t DenseOperator::bytes() const {
  return exchange_.bytes() + 3 * areas_.size() * sizeof(double);
}

}  // namespace luxel
