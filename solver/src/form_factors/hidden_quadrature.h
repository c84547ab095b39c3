#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "form_factors/hidden_kernel.h"
#include "form_factors/hidden_rules.h"
#include "form_factors/polygon.h"

namespace luxel {

/// An integral over a cell and what it may be wrong by.
struct HiddenIntegral {
  double value = 0;
  double error = 0;
  std::int64_t points = 0;

  HiddenIntegral& operator+=(const HiddenIntegral& other);
};

/// Integrals of hidden_shares() over cells of the outer patch of one pair.
class HiddenQuadrature {
 public:
  /// @param inner  the inner polygon, in front of all cells
  HiddenQuadrature(const Polygon& inner, const Vec3& normal, const Shadows& shadows,
                   HiddenWorkspace& workspace);

  /// Over cells within which the integrand is smooth: the order of each from its size against its distance
  /// from what makes the integrand vary, cut smaller where no order suffices.
  /// @param unhidden   of the whole patch, bounds the integral
  /// @param area       of the whole patch
  /// @param tolerance  of the whole patch's integral
  HiddenIntegral smooth(std::span<const Polygon> cells, double unhidden, double area, double tolerance);

  /// Over cells that may hold kinks: two rules of equal degree side by side, halved where they disagree.
  /// Cheap, and good to some thousandths. Where round bodies hide all or nothing from the rules' points but
  /// not from a corner, cells are halved too.
  /// @param halvings  at least so many, however well the rules agree
  HiddenIntegral kinked(std::span<const Polygon> cells, double area, double tolerance, int halvings = 0);

  /// Over cells that were cut along the kinks that are straight, but for those where several occluders
  /// overlap: a rule of higher degree, halved where one of lower degree disagrees, and again until the sum of
  /// their differences is within the tolerance.
  HiddenIntegral cut(std::span<const Polygon> cells, double area, double tolerance);

  /// Whether the shadows hide the inner polygon as a whole from every point of a rule over the cell.
  bool cover(const Polygon& cell);

 private:
  // Halves cells until each errs by its share of the tolerance; the sum may err by more.
  HiddenIntegral halved_to(std::span<const Polygon> cells, double area, double tolerance,
                           RulePair (*add_rules)(const Polygon&, OuterPoints&), int halvings = 0);
  double left_over(std::size_t point) const;
  double corner_excess(std::size_t begin, std::size_t corners, std::size_t end) const;
  double distance_to_edges(const Vec3& point) const;
  void place(const Polygon& cell, double unhidden, double area, double tolerance, int depth);

  const Polygon& inner_;
  Vec3 normal_;
  const Shadows& shadows_;
  HiddenWorkspace& workspace_;
  OuterPoints points_;
  std::vector<double> shares_;
  double error_ = 0;
};

}  // namespace luxel
