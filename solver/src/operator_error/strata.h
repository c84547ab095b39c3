#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "luxel/gather_operator.h"

namespace luxel {

/// The surface in pieces of equal area, each of neighbours: cut from the order of the packets.
class Strata {
 public:
  /// @param areas  N [m2]
  Strata(std::span<const GatherOperator::Packet> packets, const std::vector<double>& areas, int count);

  int count() const { return count_; }
  /// A patch of a stratum, drawn by area.
  int draw(int stratum, std::uint64_t seed) const;
  /// For each patch its stratum.
  const std::vector<std::int32_t>& of_patch() const { return of_patch_; }

 private:
  int count_;
  std::vector<int> order_;     // patches
  std::vector<double> up_to_;  // area of order_[0] .. order_[k]
  std::vector<std::int32_t> of_patch_;
};

}  // namespace luxel
