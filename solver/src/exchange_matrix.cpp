#include "luxel/exchange_matrix.h"

#include <algorithm>
#include <cstdlib>
#include <new>

namespace luxel {

void ExchangeMatrix::Free::operator()(void* data) const {
  std::free(data);
}

ExchangeMatrix::ExchangeMatrix(int size, Precision precision) : size_(size), precision_(precision) {
  // calloc of this size maps zero pages, which cost nothing until they are written
  data_.reset(std::calloc(std::max<std::size_t>(bytes(), 1), 1));
  if (!data_) throw std::bad_alloc();
}

double ExchangeMatrix::operator()(int i, int j) const {
  if (i == j) return 0;
  if (i < j) std::swap(i, j);
  return precision_ == Precision::float32 ? row<float>(i)[j] : row<double>(i)[j];
}

void ExchangeMatrix::set(int i, int j, double value) {
  if (i < j) std::swap(i, j);
  if (precision_ == Precision::float32) {
    row<float>(i)[j] = static_cast<float>(value);
  } else {
    row<double>(i)[j] = value;
  }
}

}  // namespace luxel
