#pragma once

#include <array>

#include "form_factors/patch_points.h"

namespace luxel {

/// Which quadrature is accurate enough for a pair at a given distance, for an accuracy A. The relative error
/// of a pair's form factor by the rule of level q is at most about error_constant[q] / (distance / edge)^(2
/// q): the first term that the rule leaves out. Rows and groups add up such errors weighted by form factors,
/// so that neither exceeds A.
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

/// @param accuracy  A  @param patches  of the whole scene: among many, errors of single pairs average out
RuleChoice rule_choice(double accuracy, int patches);

}  // namespace luxel
