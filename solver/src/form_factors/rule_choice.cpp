#include "form_factors/rule_choice.h"

#include <algorithm>
#include <cmath>

namespace luxel {

namespace {

// Largest relative errors of pairs of equal squares in the least favourable position, times
// (distance / edge)^(2 q). Measured; see docs/decisions/0006-unoccluded-form-factors.md.
constexpr std::array<double, point_levels + 1> error_constant{0, 8.0e-2, 4.5e-3, 1.5e-3, 7.0e-4};

// Nearer than this the first term left out no longer tells the error: for pairs that keep their gap, and for
// neighbours in nearly one plane or in two plates, whose corners may come as near as they like.
constexpr std::array<double, point_levels + 1> nearest{0, 3.0, 2.0, 1.6, 1.25};
constexpr double nearest_of_neighbours = 2.2;

}  // namespace

double RuleChoice::error(int level, double distance) {
  double power = 1;
  for (int q = 0; q < level; ++q) power *= distance * distance;
  return error_constant[level] / power;
}

RuleChoice rule_choice(double accuracy) {
  RuleChoice choice;
  for (int q = 1; q <= point_levels; ++q) {
    choice.from_if_apart[q] = std::max(std::pow(error_constant[q] / accuracy, 1.0 / (2 * q)), nearest[q]);
    choice.from[q] = std::max(choice.from_if_apart[q], nearest_of_neighbours);
  }
  choice.fine = accuracy < 2e-7;
  choice.pair_tolerance = 0.01 * accuracy;
  return choice;
}

}  // namespace luxel
