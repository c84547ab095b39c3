#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "luxel/gather_operator.h"

namespace luxel {

/// The surface in pieces of equal measure, area or another, each of neighbours: cut from the order of the
/// packets.
class Strata {
 public:
  /// @param measures  N, of each patch, > 0
  Strata(std::span<const GatherOperator::Packet> packets, const std::vector<double>& measures, int count);

  int count() const { return count_; }
  /// The patches, neighbours together.
  std::span<const int> order() const { return order_; }
  /// A patch of a stratum, drawn by measure.
  int draw(int stratum, std::uint64_t seed) const;
  /// For each patch its stratum.
  const std::vector<std::int32_t>& of_patch() const { return of_patch_; }

 private:
  int count_;
  std::vector<int> order_;     // patches
  std::vector<double> up_to_;  // measure of order_[0] .. order_[k]
  std::vector<std::int32_t> of_patch_;
};

}  // namespace luxel
