#pragma once

#include <memory>
#include <vector>

#include "luxel/transport_operator.h"
#include "transport/hierarchical/block_product.h"

namespace luxel {

/// F between the unknowns of a block product, D F D + diagonal once its rows are closed.
class CoarseOperator : public TransportOperator {
 public:
  /// @param areas  of the unknowns [m2], proportional to the product's
  CoarseOperator(BlockProduct product, std::vector<double> areas);

  /// Scales by these factors, and puts what the closed rows then lack of 1 on their diagonal.
  void close(std::vector<double> factors, const std::vector<char>& closed);

  int size() const override { return static_cast<int>(areas_.size()); }
  void apply(const double* x, double* y, int columns) const override;
  std::span<const double> row_sums() const override { return row_sums_; }
  std::span<const double> areas() const override { return areas_; }
  bool symmetric() const override { return true; }
  std::size_t bytes() const override;
  std::string_view kind() const override { return "hierarchical"; }

  double largest_correction() const { return largest_correction_; }

 private:
  BlockProduct product_;
  std::vector<double> areas_, row_sums_;
  std::vector<double> factors_, diagonal_;  // empty: none
  double largest_correction_ = 0;
};

}  // namespace luxel
