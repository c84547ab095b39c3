#pragma once

#include <span>

namespace luxel {

/// Sum of the numbers one after the other. Eigen's sum() of a vector starts its groups of four where the
/// memory is aligned, so that the last bit depends on where the allocator put it.
inline double ordered_sum(std::span<const double> numbers) {
  double sum = 0;
  for (const double number : numbers) sum += number;
  return sum;
}

}  // namespace luxel
