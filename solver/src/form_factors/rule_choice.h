#pragma once

#include <array>

#include "form_factors/patch_points.h"

namespace luxel {

/// Which quadrature is accurate enough for a pair at a given distance, for a wanted row error A. The error of
/// a pair's form factor by the rule of level q, relative to what an unobstructed facing patch would receive,
/// is at most error_constant[q] / (distance / edge)^(2 q): the first term that the rule leaves out. Rows add
/// up such errors weighted by form factors, whose sum is at most 1.
struct RuleChoice {
  /// Smallest distance of the centres, in longest edges, from which level q may be used; index 0 unused.
  std::array<double, point_levels + 1> from;
  /// The same for a pair that is known to keep a gap of `wide_gap` edges everywhere: centres alone do not
  /// tell this of neighbours.
  std::array<double, point_levels + 1> from_if_apart;
  static constexpr double wide_gap = 0.6;
  bool fine = false;          ///< reciprocals to full double precision
  double pair_tolerance = 0;  ///< absolute error of a near pair's form factor from its smaller patch

  /// 1 .. point_levels, or 0: the contour integral. @param distance  in longest edges
  int level(double distance) const { return first_level(from, distance); }
  int level_if_apart(double distance) const { return first_level(from_if_apart, distance); }

  /// Estimated relative error of level q at this distance.
  static double error(int level, double distance);

 private:
  static int first_level(const std::array<double, point_levels + 1>& smallest, double distance) {
    for (int q = 1; q <= point_levels; ++q) {
      if (distance >= smallest[q]) return q;
    }
    return 0;
  }
};

RuleChoice rule_choice(double accuracy);

}  // namespace luxel
