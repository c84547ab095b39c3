#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "form_factors/event_cuts.h"
#include "form_factors/hidden_kernel.h"
#include "form_factors/hidden_rules.h"
#include "luxel/form_factors.h"

namespace luxel {
namespace {

Polygon rectangle(double x0, double y0, double x1, double y1, double z) {
  Polygon polygon;
  polygon.count = 4;
  polygon.corners[0] = {x0, y0, z};
  polygon.corners[1] = {x1, y0, z};
  polygon.corners[2] = {x1, y1, z};
  polygon.corners[3] = {x0, y1, z};
  return polygon;
}

Polygon reversed(Polygon polygon) {
  std::reverse(polygon.corners.begin(), polygon.corners.begin() + polygon.count);
  return polygon;
}

// The cone of sight that a polygon blocks for eyes on the side from which its corners run counter-clockwise.
void add_shadow(Shadows& shadows, const Polygon& polygon) {
  for (int k = 0; k < polygon.count; ++k) shadows.edges.push_back({polygon[k], polygon.next(k)});
  shadows.begin.push_back(static_cast<int>(shadows.edges.size()));
  shadows.cut.push_back(0);
  find_ties(shadows);
}

// Eyes on the floor look up at a ceiling at z = 1.
class HiddenShares : public ::testing::Test {
 protected:
  HiddenShares() {
    for (int k = 0; k < 11; ++k) eyes_.add(Vec3(0.013 + 0.083 * k, 0.91 - 0.07 * k, 0), 1);
  }
  std::vector<double> hidden(std::initializer_list<Polygon> occluders) {
    Shadows shadows;
    for (const Polygon& occluder : occluders) add_shadow(shadows, occluder);
    std::vector<double> shares;
    HiddenWorkspace workspace;
    hidden_shares(eyes_, Vec3::UnitZ(), ceiling_, shadows, workspace, shares);
    return shares;
  }
  // Lambert's form factor of the part of the ceiling behind a rectangle at height z, from the same eyes.
  std::vector<double> expected(double x0, double y0, double x1, double y1, double z) {
    std::vector<double> shares;
    for (std::size_t k = 0; k < eyes_.size(); ++k) {
      const double x = eyes_.x[k], y = eyes_.y[k];
      auto onto = [z](double eye, double at) { return std::clamp(eye + (at - eye) / z, 0.0, 1.0); };
      const double u0 = onto(x, x0), u1 = onto(x, x1), v0 = onto(y, y0), v1 = onto(y, y1);
      const Polygon part = reversed(rectangle(u0, v0, u1, v1, 1));
      shares.push_back(u1 > u0 && v1 > v0
                           ? point_form_factor({x, y, 0}, Vec3::UnitZ(), std::span(part.corners.data(), 4))
                           : 0);
    }
    return shares;
  }
  // Polygons seen from below run clockwise when seen from above.
  static Polygon blocker(double x0, double y0, double x1, double y1, double z) {
    return reversed(rectangle(x0, y0, x1, y1, z));
  }

  OuterPoints eyes_;
  Polygon ceiling_ = reversed(rectangle(0, 0, 1, 1, 1));
};

// rounding of a dozen arc tangents
constexpr double rounding = 2e-14;

void expect_equal(const std::vector<double>& a, const std::vector<double>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k], b[k], rounding) << "eye " << k;
}

TEST_F(HiddenShares, AreTheFormFactorOfTheShadow) {
  expect_equal(hidden({blocker(0.3, 0.2, 0.7, 0.45, 0.5)}), expected(0.3, 0.2, 0.7, 0.45, 0.5));
}

TEST_F(HiddenShares, CountAnOverlapOnce) {
  const auto both = hidden({blocker(0.2, 0.2, 0.6, 0.6, 0.5), blocker(0.4, 0.4, 0.8, 0.7, 0.5)});

  const auto first = expected(0.2, 0.2, 0.6, 0.6, 0.5), second = expected(0.4, 0.4, 0.8, 0.7, 0.5);
  const auto overlap = expected(0.4, 0.4, 0.6, 0.6, 0.5);
  for (std::size_t k = 0; k < both.size(); ++k) {
    EXPECT_NEAR(both[k], first[k] + second[k] - overlap[k], rounding);
  }
}

TEST_F(HiddenShares, OfASheetInPiecesAreThoseOfTheSheet) {
  const auto pieces = hidden(
      {blocker(0.2, 0.2, 0.5, 0.6, 0.4), blocker(0.5, 0.2, 0.8, 0.6, 0.4), blocker(0.2, 0.6, 0.8, 0.7, 0.4)});

  expect_equal(pieces, expected(0.2, 0.2, 0.8, 0.7, 0.4));
}

TEST_F(HiddenShares, OfTheSameSheetThriceAreThoseOfOne) {
  const Polygon sheet = blocker(0.25, 0.3, 0.55, 0.9, 0.6);

  expect_equal(hidden({sheet, sheet, sheet}), expected(0.25, 0.3, 0.55, 0.9, 0.6));
}

TEST_F(HiddenShares, OfManySheetsOneBehindAnotherAreThoseOfTheirUnion) {
  // sheets at several heights, cut so that each hides the same rectangle of the ceiling from (0.5, 0.5, 0);
  // the eye is beside it, so that no two edges lie in a plane with it
  OuterPoints one;
  one.add(Vec3(0.5 + 1e-9, 0.5 + 3e-9, 0), 1);
  eyes_ = one;
  auto scaled = [](double z) {
    auto at = [z](double x) { return 0.5 + (x - 0.5) * z; };
    return blocker(at(0.1), at(0.3), at(0.6), at(0.8), z);
  };

  const auto shares =
      hidden({scaled(0.2), scaled(0.5), scaled(0.7), scaled(0.9), blocker(0.5, 0.5, 0.52, 0.53, 0.3)});

  // the shadows move by up to 1e-8 where the eye does by 3e-9
  EXPECT_NEAR(shares[0], expected(0.1, 0.3, 0.6, 0.8, 1)[0], 1e-7);
}

TEST(AddPoints, IntegratesPolynomials) {
  Polygon cell;  // a convex pentagon
  cell.count = 5;
  cell.corners[0] = {0, 0, 0};
  cell.corners[1] = {1, 0.1, 0};
  cell.corners[2] = {1.2, 0.7, 0};
  cell.corners[3] = {0.5, 1.1, 0};
  cell.corners[4] = {-0.1, 0.6, 0};
  auto integral = [&](int order, int px, int py) {
    OuterPoints points;
    add_points(cell, order, points);
    double sum = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
      sum += points.weight[k] * std::pow(points.x[k], px) * std::pow(points.y[k], py);
    }
    return sum;
  };

  EXPECT_NEAR(integral(1, 0, 0), area(cell, Vec3::UnitZ()), 1e-14);
  EXPECT_NEAR(integral(2, 1, 1), integral(4, 1, 1), 3e-9);  // points are moved by 1e-9 of the cell on purpose
  EXPECT_NEAR(integral(3, 2, 1), integral(4, 2, 1), 3e-9);
}

TEST(CutByEvents, KeepsTheAreaAndCutsWhereTheShadowChanges) {
  const Polygon floor = rectangle(0, 0, 1, 1, 0), ceiling = reversed(rectangle(0, 0, 1, 1, 1));
  Shadows shadows;
  add_shadow(shadows, reversed(rectangle(0.4, 0.3, 2, 2, 0.5)));

  const auto cells = cut_by_events(floor, Vec3::UnitZ(), ceiling, shadows, 1, 100);

  // the corner (0.4, 0.3) falls on the ceiling's edges for x = 0.8 and y = 0.6
  double total = 0;
  EXPECT_EQ(cells.size(), 4u);
  for (const Polygon& cell : cells) {
    total += area(cell, Vec3::UnitZ());
    const Vec3 middle = centroid(cell);
    for (int k = 0; k < cell.count; ++k) {
      EXPECT_GE((cell[k].x() - 0.8) * (middle.x() - 0.8), -1e-12);
      EXPECT_GE((cell[k].y() - 0.6) * (middle.y() - 0.6), -1e-12);
    }
  }
  EXPECT_NEAR(total, 1, 1e-14);
}

}  // namespace
}  // namespace luxel
