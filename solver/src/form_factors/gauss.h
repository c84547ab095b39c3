#pragma once

#include <span>

namespace luxel {

/// Gauss-Legendre rule on [0, 1]: exact for polynomials of degree 2 order - 1; the weights add up to 1.
struct GaussRule {
  static constexpr int largest_order = 24;
  std::span<const double> nodes;
  std::span<const double> weights;
};

/// @param order  number of points, 1 .. GaussRule::largest_order
GaussRule gauss_rule(int order);

}  // namespace luxel
