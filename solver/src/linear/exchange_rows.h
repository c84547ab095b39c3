#pragma once

#include <stdexcept>

#include "luxel/exchange_matrix.h"
#include "luxel/transport_operator.h"

namespace luxel {

/// The exchange areas A_i F_ij of an operator that has entries, with its diagonal.
class ExchangeRows {
 public:
  /// @throws std::invalid_argument where the operator has no entries
  explicit ExchangeRows(const TransportOperator& transport)
      : entries_(transport.entries()), diagonal_(transport.diagonal()) {
    if (!entries_) throw std::invalid_argument("solve: this method needs an operator with entries");
  }

  int size() const { return entries_->size(); }

  /// A_i F_ij for any i, j.
  double operator()(int i, int j) const {
    if (i != j) return (*entries_)(i, j);
    return diagonal_.empty() ? 0 : diagonal_[i];
  }

  double diagonal(int i) const { return (*this)(i, i); }

  /// Calls body(pointer to A_i F_ij, j < i) with the numbers as stored, float or double.
  template <class Body>
  void lower_row(int i, const Body& body) const {
    if (entries_->precision() == Precision::float32) {
      body(entries_->row<float>(i));
    } else {
      body(entries_->row<double>(i));
    }
  }

 private:
  const ExchangeMatrix* entries_;
  std::span<const double> diagonal_;
};

}  // namespace luxel
