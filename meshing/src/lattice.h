#pragma once

#include <array>
#include <span>
#include <vector>

#include "polygon.h"

namespace luxel {

/// Points of a hexagonal lattice inside a border, in rows, aligned with its longest straight part and scaled
/// to fit the extent; none near the border or near a crease, so that no small angle arises there.
class HexagonalLattice {
 public:
  /// `axis` is a direction of the rows; border and crease parts are about `edge_length` long each.
  HexagonalLattice(std::span<const std::array<Vec2, 2>> border, std::span<const std::array<Vec2, 2>> creases,
                   const std::array<Vec2, 2>& axis, double edge_length);

  std::size_t size() const { return size_; }

  /// Rows alternate in direction, so that neighbours in the list are neighbours in the plane.
  std::vector<Vec2> points() const;

 private:
  struct Run {  // lattice places first .. last of one row, with a flag each from `flags` on
    int first, last;
    std::size_t flags;
  };

  Vec2 place(int row, int column) const;
  double column_of(int row, double x) const;
  int row_from(double y) const;
  void find_runs(std::span<const std::array<Vec2, 2>> border);
  void clear_near(const Vec2& a, const Vec2& b);

  Vec2 origin_, along_;  // where column 0 of row 0 stands, and the direction of the rows
  double column_step_, row_step_, edge_length_;
  double bottom_ = 0;  // ordinate of row 0
  int row_count_ = 0;
  std::vector<std::vector<Run>> rows_;
  std::vector<char> free_;
  std::size_t size_ = 0;
};

}  // namespace luxel
