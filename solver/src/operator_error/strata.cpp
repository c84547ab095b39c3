#include "operator_error/strata.h"

#include <algorithm>

#include "sampling/owen_sobol.h"

namespace luxel {

Strata::Strata(std::span<const GatherOperator::Packet> packets, const std::vector<double>& measures) {
  order_.reserve(measures.size());
  up_to_.reserve(measures.size());
  double measure = 0;
  for (const auto& packet : packets) {
    for (const int patch : packet) {
      if (patch < 0) continue;
      order_.push_back(patch);
      up_to_.push_back(measure += measures[patch]);
    }
  }
}

int Strata::draw(int stratum, int count, std::uint64_t seed) const {
  const double at = (stratum + 0x1p-53 * static_cast<double>(mixed_seed(seed, stratum) >> 11)) / count;
  const auto place = std::lower_bound(up_to_.begin(), up_to_.end(), at * up_to_.back());
  return order_[std::min<std::size_t>(place - up_to_.begin(), order_.size() - 1)];
}

std::vector<std::int32_t> Strata::of_patch(int count) const {
  std::vector<std::int32_t> result(order_.size(), 0);
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const double middle = (up_to_[k] + (k > 0 ? up_to_[k - 1] : 0)) / 2;
    result[order_[k]] = std::clamp(static_cast<int>(middle / up_to_.back() * count), 0, count - 1);
  }
  return result;
}

}  // namespace luxel
