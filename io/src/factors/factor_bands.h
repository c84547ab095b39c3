#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "luxel/dense_operator.h"

namespace luxel {

/// Some consecutive rows of F, all N columns of each.
struct FactorBand {
  int first = 0;
  int rows = 0;
  int columns = 0;
  std::vector<double> values;  ///< rows x columns, row-major

  std::span<const double> row(int k) const {
    return std::span(values).subspan(static_cast<std::size_t>(k) * columns, columns);
  }
};

/// Hands out F from first row to last in bands of at most `rows_a_band` rows. The half that is not stored is
/// read as blocks of columns, so that each band costs one pass over contiguous pieces.
void for_each_band(const DenseOperator& transport, const std::function<void(const FactorBand&)>& visit);

/// How many F_ij of each row are not 0.
std::vector<std::int64_t> entries_by_row(const DenseOperator& transport);

}  // namespace luxel
