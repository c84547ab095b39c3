#include "form_factors/gauss.h"

#include <array>
#include <cmath>
#include <numbers>

namespace luxel {

namespace {

struct Table {
  static constexpr int n = GaussRule::largest_order;
  std::array<std::array<double, n>, n + 1> nodes, weights;

  // Newton on the Legendre polynomial from Tricomi's guess.
  Table() {
    for (int order = 1; order <= n; ++order) {
      for (int k = 0; k < order; ++k) {
        double x = std::cos(std::numbers::pi * (k + 0.75) / (order + 0.5));
        double slope = 1;
        for (int step = 0; step < 8; ++step) {
          double below = 1, value = x;
          for (int j = 2; j <= order; ++j) {
            const double above = ((2 * j - 1) * x * value - (j - 1) * below) / j;
            below = value;
            value = above;
          }
          slope = order * (x * value - below) / (x * x - 1);
          x -= value / slope;
        }
        nodes[order][k] = 0.5 * (1 - x);
        weights[order][k] = 1 / ((1 - x * x) * slope * slope);
      }
    }
  }
};

}  // namespace

GaussRule gauss_rule(int order) {
  static const Table table;
  const auto count = static_cast<std::size_t>(order);
  return {{table.nodes[order].data(), count}, {table.weights[order].data(), count}};
}

}  // namespace luxel
