#include "form_factors/rule_choice.h"

#include <algorithm>
#include <cmath>

namespace luxel {

namespace {

// Relative errors of pairs of unit squares in random positions, times (distance / edge)^(2 q): what 99 of 100
// stay below, so that single factors between far patches are as right as was asked, and not only their sums
// over a row.
constexpr std::array<double, point_levels + 1> error_constant{0, 1.5, 0.33, 0.024, 0.0028};

// Rows and groups of many patches average over positions: the mean error is this share of what 99 of 100 stay
// below, and near that of directly opposed squares, for which the series of the kernel gives 2/3 at q = 1 and
// 1/15 at q = 2.
constexpr double share_of_many = 0.25;

// From this many patches on, groups are taken to hold many. Below, the stricter rule costs under 0.1 CPU
// seconds.
constexpr int many_patches = 2000;

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

RuleChoice rule_choice(double accuracy, int patches) {
  const double share = patches < many_patches ? 1 : share_of_many;
  RuleChoice choice;
  for (int q = 1; q <= point_levels; ++q) {
    choice.from_if_apart[q] =
        std::max(std::pow(share * error_constant[q] / accuracy, 1.0 / (2 * q)), nearest[q]);
    choice.from[q] = std::max(choice.from_if_apart[q], nearest_of_neighbours);
  }
  choice.fine = accuracy < 2e-7;
  choice.pair_tolerance = 0.01 * accuracy;
  return choice;
}

}  // namespace luxel
