#include "lattice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace luxel {
namespace {

/// The border of a square with this corner, side and direction, each side in n parts.
std::vector<std::array<Vec2, 2>> square(const Vec2& corner, double side, double angle, int n) {
  const Vec2 u = side * Vec2(std::cos(angle), std::sin(angle));
  const Vec2 v(-u.y(), u.x());
  const std::array<Vec2, 4> corners = {corner, corner + u, corner + u + v, corner + v};
  std::vector<std::array<Vec2, 2>> parts;
  for (int k = 0; k < 4; ++k) {
    Vec2 from = corners[k];
    const Vec2 d = corners[(k + 1) % 4] - from;
    for (int i = 1; i <= n; ++i) {
      const Vec2 to = i < n ? Vec2(corners[k] + d * (static_cast<double>(i) / n)) : corners[(k + 1) % 4];
      parts.push_back({from, to});
      from = to;
    }
  }
  return parts;
}

TEST(HexagonalLattice, LosesNoRowWhereBorderPointsStandOnIt) {
  // Rows are 1/18 of the side apart, border points 1/18 or 1/6: on the rows, above or below by rounding.
  for (const int parts : {6, 9, 18}) {
    for (const double side : {1.0, 1e-6, 0.3, 7.0}) {
      for (const double angle : {0.0, 0.1, 0.7, 1.1, 2.9}) {
        const auto border = square({0.1 * side, -0.7 * side}, side, angle, parts);
        const std::array<Vec2, 2> axis = {border[0][0], border[parts - 1][1]};
        const double edge_length = side / (18 * 0.8660254);

        const HexagonalLattice lattice(border, {}, axis, edge_length);

        const Vec2 along = (axis[1] - axis[0]).normalized();
        std::map<long, int> rows;
        for (const Vec2& p : lattice.points()) {
          const Vec2 x = p - axis[0];
          ++rows[std::lround(18 * (along.x() * x.y() - along.y() * x.x()) / side)];
        }
        EXPECT_EQ(rows.size(), 17u);
        for (const auto& [row, count] : rows) EXPECT_GE(count, 13) << row;  // of 15 or 16 places
      }
    }
  }
}

}  // namespace
}  // namespace luxel
