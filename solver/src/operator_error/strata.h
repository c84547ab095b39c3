#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "luxel/gather_operator.h"

namespace luxel {

/// The surface along a curve, cut into pieces of equal measure, area or another, each of neighbours: as the
/// packets follow one another.
class Strata {
 public:
  /// @param measures  N, of each patch, > 0
  Strata(std::span<const GatherOperator::Packet> packets, const std::vector<double>& measures);

  /// The patches, neighbours together.
  std::span<const int> order() const { return order_; }
  /// A patch of one of `count` strata, drawn by measure.
  int draw(int stratum, int count, std::uint64_t seed) const;
  /// For each patch the one of `count` strata that its middle lies in.
  std::vector<std::int32_t> of_patch(int count) const;

 private:
  std::vector<int> order_;
  std::vector<double> up_to_;  // measure of order_[0] .. order_[k]
};

}  // namespace luxel
