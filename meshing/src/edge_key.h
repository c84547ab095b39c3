#pragma once

#include <algorithm>
#include <cstdint>

namespace luxel {

/// A number for the edge between two vertices, whatever its direction.
inline std::uint64_t edge_key(int a, int b) {
  return static_cast<std::uint64_t>(std::min(a, b)) << 32 | static_cast<std::uint32_t>(std::max(a, b));
}

}  // namespace luxel
