#pragma once

#include <cstdint>
#include <vector>

namespace luxel {

/// The places 0 .. n - 1 of n keys, the smallest key first, equal keys by place. Cost: linear (a radix sort,
/// one pass for every 11 bits in which the keys differ).
std::vector<int> order_by_key(const std::vector<std::uint64_t>& keys);

}  // namespace luxel
