#include "operator_error/strata.h"

#include <algorithm>

#include "sampling/owen_sobol.h"

namespace luxel {

Strata::Strata(std::span<const GatherOperator::Packet> packets, const std::vector<double>& measures,
               int count)
    : count_(count), of_patch_(measures.size(), 0) {
  order_.reserve(measures.size());
  for (const auto& packet : packets) {
    for (const int patch : packet) {
      if (patch >= 0) order_.push_back(patch);
    }
  }
  double measure = 0;
  for (const int patch : order_) up_to_.push_back(measure += measures[patch]);
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const double middle = up_to_[k] - measures[order_[k]] / 2;
    of_patch_[order_[k]] = std::clamp(static_cast<int>(middle / measure * count), 0, count - 1);
  }
}

int Strata::draw(int stratum, std::uint64_t seed) const {
  const double at = (stratum + 0x1p-53 * static_cast<double>(mixed_seed(seed, stratum) >> 11)) / count_;
  const auto place = std::lower_bound(up_to_.begin(), up_to_.end(), at * up_to_.back());
  return order_[std::min<std::size_t>(place - up_to_.begin(), order_.size() - 1)];
}

}  // namespace luxel
