#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "form_factors/gauss.h"
#include "luxel/form_factors.h"

namespace luxel {
namespace {

using Corners = std::vector<Vec3>;
constexpr double pi = std::numbers::pi;

Corners flipped(Corners corners) {
  std::reverse(corners.begin(), corners.end());
  return corners;
}

double area(const Corners& corners) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
    sum += (corners[k] - corners[0]).cross(corners[k + 1] - corners[0]);
  }
  return 0.5 * sum.norm();
}

// The rectangle [x0, x1] x [y0, y1] at height z, facing up.
Corners level(double x0, double x1, double y0, double y1, double z) {
  return {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
}

// The rectangle y in [y0, y1], z in [z0, z1] at x = 0, facing +x.
Corners upright(double y0, double y1, double z0, double z1) {
  return {{0, y0, z0}, {0, y1, z0}, {0, y1, z1}, {0, y0, z1}};
}

struct Rectangles {
  double x[2], y[2], eta[2], xi[2];
};

// Source: Ehlert and Smith 1993; Howell's catalogue C-13 (parallel, distance z) and C-15 (perpendicular).
template <class Kernel>
double alternating_sum(const Rectangles& r, Kernel kernel) {
  double sum = 0;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      for (int k = 0; k < 2; ++k) {
        for (int l = 0; l < 2; ++l) {
          sum += ((i + j + k + l) % 2 ? -1 : 1) * kernel(r.x[i], r.y[j], r.eta[k], r.xi[l]);
        }
      }
    }
  }
  return sum / (2 * pi);
}

double parallel_exchange(const Rectangles& r, double z) {
  return alternating_sum(r, [z](double x, double y, double eta, double xi) {
    const double u = x - xi, v = y - eta;
    const double p = std::hypot(u, z), q = std::hypot(v, z);
    return v * p * std::atan(v / p) + u * q * std::atan(u / q) -
           0.5 * z * z * std::log(u * u + v * v + z * z);
  });
}

double perpendicular_exchange(const Rectangles& r) {
  return alternating_sum(r, [](double x, double y, double eta, double xi) {
    const double c2 = x * x + xi * xi, c = std::sqrt(c2), d = y - eta, s = c2 + d * d;
    return (c > 0 ? d * c * std::atan(d / c) : 0) - (s > 0 ? 0.25 * (c2 - d * d) * std::log(s) : 0);
  });
}

struct Published {
  const char* name;
  Corners a, b;
  double f12;
  double tolerance;  // relative: the digits that the value is known to, never below 1e-12
};

// Howell, A Catalog of Radiation Heat Transfer Configuration Factors, C-11, C-13 to C-16, evaluated in high
// precision; Narayanaswamy, J. Quant. Spectrosc. Radiat. Transfer 2015, examples 4 and 5a; a sliver by
// quadrature of Lambert's formula. The polygons' orientation is set so that they face each other.
TEST(ExchangeArea, AgreesWithPublishedPolygons) {
  const double c45 = std::sqrt(0.5), c60 = std::sqrt(0.75);
  const double c5 = std::cos(5 * pi / 180), s5 = std::sin(5 * pi / 180);
  const std::vector<Published> cases{
      {"C-11 at 1", level(0, 1, 0, 1, 0), flipped(level(0, 1, 0, 1, 1)), 0.199824895698387, 1e-12},
      {"C-11 at 10", level(0, 1, 0, 1, 0), flipped(level(0, 1, 0, 1, 10)), 0.00316205683875760, 1e-12},
      {"C-11 3 x 1", level(0, 3, 0, 1, 0), flipped(level(0, 3, 0, 1, 0.5)), 0.544209724559316, 1e-12},
      {"gap 1e-3", level(0, 1, 0, 1, 0), flipped(level(0, 1, 0, 1, 1e-3)), 0.998005631907580, 1e-12},
      {"gap 1e-6", level(0, 1, 0, 1, 0), flipped(level(0, 1, 0, 1, 1e-6)), 0.999998000010030, 1e-12},
      {"far 1e3", level(0, 1, 0, 1, 0), flipped(level(0, 1, 0, 1, 1000)), 3.18309673977380e-7, 1e-12},
      {"EES C-13", level(0.1, 0.2, 0.1, 0.2, 0), flipped(level(0.1, 0.2, 0.1, 0.2, 0.05)), 0.415253283577147,
       1e-12},
      {"C-13 offset", level(0, 1, 0, 1, 0), flipped(level(1, 2, 0, 1, 1)), 0.0860504891523273, 1e-12},
      {"size ratio 1e6", level(0, 1e-6, 0, 1e-6, 0), flipped(level(-0.5, 0.5, -0.5, 0.5, 1)),
       0.239456470460591, 1e-12},
      {"small over big", level(0.4, 0.6, 0.4, 0.6, 0), flipped(level(0, 1, 0, 1, 0.25)), 0.825780160030024,
       1e-12},
      {"C-14 cube", level(0, 1, 0, 1, 0), upright(0, 1, 0, 1), 0.20004377607540, 1e-12},
      {"C-14 1 x 3 x 2", level(0, 1, 0, 3, 0), upright(0, 3, 0, 2), 0.31899670147905, 1e-12},
      {"C-15 gap", level(0.5, 1.5, 0, 1, 0), upright(0, 1, 0, 1), 0.076136640422678, 1e-12},
      {"corner touch", level(0, 1, 0, 1, 0), upright(1, 2, 0, 1), 0.040592230101559, 1e-12},
      {"C-16 5 deg",
       level(0, 1, 0, 1, 0),
       {{0, 0, 0}, {0, 1, 0}, {c5, 1, s5}, {c5, 0, s5}},
       0.920261908111,
       1e-12},
      {"C-16 45 deg",
       level(0, 1, 0, 1, 0),
       {{0, 0, 0}, {0, 1, 0}, {c45, 1, c45}, {c45, 0, c45}},
       0.483347695479,
       2e-12},
      {"C-16 60 deg",
       level(0, 1, 0, 1, 0),
       {{0, 0, 0}, {0, 1, 0}, {0.5, 1, c60}, {0.5, 0, c60}},
       0.370905321150,
       2e-12},
      {"C-16 120 deg",
       level(0, 1, 0, 1, 0),
       {{0, 0, 0}, {0, 1, 0}, {-0.5, 1, c60}, {-0.5, 0, c60}},
       0.0866150011183,
       1e-12},
      {"Narayanaswamy 4",
       {{0, 0, 0}, {1, 1, 0}, {0, 1, 0}},
       {{1, 0, 1}, {0, 1, 1}, {1, 1, 1}},
       0.099912447849194,
       1e-12},
      {"Narayanaswamy 5a",
       {{0, 0.5, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
       {{2, 0.5, 0}, {3, 0, 0.5}, {3, 2, 0.5}, {2, 1.5, 0}},
       0.0044422803023289,
       1e-12},
      {"sliver 1e4",
       {{0, 0, 0}, {1, 0, 0}, {0.5, 1e-4, 0}},
       flipped(level(0, 1, -0.5, 0.5, 0.5)),
       0.51666988682,
       2e-11},
      {"sliver 1e5",
       {{0, 0, 0}, {1, 0, 0}, {0.5, 1e-5, 0}},
       flipped(level(0, 1, -0.5, 0.5, 0.5)),
       0.51666988823,
       2e-11},
  };

  for (const Published& known : cases) {
    const double exchange = exchange_area(known.a, known.b);

    EXPECT_NEAR(exchange / area(known.a) / known.f12, 1, known.tolerance) << known.name;
    EXPECT_NEAR(exchange_area(known.b, known.a) / exchange, 1, 1e-12) << known.name << ", reversed";
  }
}

TEST(ExchangeArea, AgreesWithTheRegularTetrahedron) {
  const Vec3 a(-1, 1, -1), b(1, -1, -1), c(1, 1, 1), d(-1, -1, 1);

  // Every pair has F = 1/3 by symmetry.
  EXPECT_NEAR(exchange_area(Corners{a, b, c}, Corners{b, d, c}) / area({a, b, c}), 1.0 / 3, 1e-13);
}

// Edges that touch over part of their length: the logarithm is singular in the middle of an edge.
TEST(ExchangeArea, IsRightWhereEdgesTouchInPart) {
  for (const auto& [y0, y1] : {std::pair(0.3, 1.7), {0.25, 0.5}, {-0.4, 0.1}, {1.0, 1.3}, {-1.0, 2.0}}) {
    const double exchange = exchange_area(level(0, 1, 0, 1, 0), upright(y0, y1, 0, 0.8));

    const double exact = perpendicular_exchange({{0, 1}, {0, 1}, {y0, y1}, {0, 0.8}});
    EXPECT_NEAR(exchange / exact, 1, 1e-11) << y0 << " " << y1;
  }
}

// A wall that stands in the middle of a floor sees the part of the floor in front of it only.
TEST(ExchangeArea, ClipsPolygonsByEachOthersPlane) {
  const double whole = exchange_area(level(-1, 1, 0, 1, 0), upright(0.2, 0.7, -0.5, 0.6));

  EXPECT_NEAR(whole / perpendicular_exchange({{0, 1}, {0, 1}, {0.2, 0.7}, {0, 0.6}}), 1, 1e-11);
}

TEST(ExchangeArea, AgreesWithParallelRectanglesAtAnyOffset) {
  for (const double shift : {0.0, 0.5, 1.0, 3.0}) {
    for (const double height : {0.1, 1.0, 2.0}) {
      const double exchange =
          exchange_area(level(0, 1, 0, 2, 0), flipped(level(shift, shift + 0.7, -shift, 1, height)));

      const double exact = parallel_exchange({{0, 1}, {0, 2}, {-shift, 1}, {shift, shift + 0.7}}, height);
      // the sum of 16 terms of order 1 loses 1e-15
      EXPECT_NEAR(exchange, exact, 1e-11 * exact + 2e-15) << shift << " " << height;
    }
  }
}

TEST(ExchangeArea, IsZeroBehindAndInOnePlane) {
  EXPECT_EQ(exchange_area(level(0, 1, 0, 1, 0), level(0, 1, 0, 1, 1)), 0);
  EXPECT_EQ(exchange_area(level(0, 1, 0, 1, 0), level(1, 2, 0, 1, 0)), 0);
  EXPECT_EQ(exchange_area(level(0, 1, 0, 1, 0), flipped(level(0, 1, 0, 1, -1))), 0);
}

TEST(ExchangeArea, KeepsItsDigitsInSliversThatTouch) {
  for (const double width : {1e-2, 1e-4, 1e-6}) {
    const double exchange = exchange_area(level(0, width, 0, 1, 0), upright(0, 1, 0, 1));

    // a strip of the floor at the foot of the wall: half of what it sends, less 1 / 2 pi sqrt-type ends; the
    // closed form itself loses 1e-16 / width
    const double exact = perpendicular_exchange({{0, width}, {0, 1}, {0, 1}, {0, 1}});
    EXPECT_NEAR(exchange / exact, 1, 1e-12 + 1e-15 / width) << width;
  }
}

TEST(ExchangeArea, KeepsItsDigitsFarApart) {
  for (const double distance : {1e2, 1e4, 1e6}) {
    const double exchange = exchange_area(level(0, 1, 0, 1, 0), flipped(level(0, 1, 0, 1, distance)));

    // F = 1 / (pi d^2) (1 - <s^2> 2 / d^2 + ..), <s^2> = 1/3 the mean square of the offset
    const double square = 1 / (distance * distance);
    const double series = square / pi * (1 - 2.0 / 3 * square);
    EXPECT_NEAR(exchange / series, 1, 1e-14 + 4 * square * square) << distance;
  }
}

// The form factor of a small square from all its points, by a Gauss rule that is exact to rounding half the
// square's size away from the wall.
double share_of_points(const Vec3& corner, double size, const Corners& wall) {
  const GaussRule rule = gauss_rule(20);
  double sum = 0;
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) {
      const Vec3 x = corner + size * Vec3(rule.nodes[i], rule.nodes[j], 0);
      sum += rule.weights[i] * rule.weights[j] * point_form_factor(x, Vec3::UnitZ(), wall);
    }
  }
  return sum;
}

TEST(ExchangeArea, KeepsItsDigitsAtAnySizeRatio) {
  for (const double size : {1e-3, 1e-6, 1e-9}) {
    const Vec3 corner(0.5 * size, 0.5, 0);
    const Corners square = level(corner[0], corner[0] + size, corner[1], corner[1] + size, 0);

    const double share = exchange_area(square, upright(0, 1, 0, 1)) / (size * size);

    // the square's corners at y = 0.5 carry 1e-16 / size
    EXPECT_NEAR(share / share_of_points(corner, size, upright(0, 1, 0, 1)), 1, 1e-12 + 2e-16 / size) << size;
  }
}

// Closure holds for every wedge: prisms over triangles with an angle from 5 to 175 degrees.
TEST(ExchangeArea, ClosesTriangularPrisms) {
  for (const double degrees : {5.0, 30.0, 90.0, 150.0, 175.0}) {
    const double angle = degrees * pi / 180;
    const Vec3 a(0, 0, 0), b(1, 0, 0), c(std::cos(angle), std::sin(angle), 0), up(0, 0, 0.7);
    const std::vector<Corners> faces{{a, b, c},
                                     {a + up, c + up, b + up},
                                     {a, a + up, b + up, b},
                                     {b, b + up, c + up, c},
                                     {c, c + up, a + up, a}};

    for (std::size_t i = 0; i < faces.size(); ++i) {
      double sum = 0;
      for (std::size_t j = 0; j < faces.size(); ++j) {
        if (i != j) sum += exchange_area(faces[i], faces[j]);
      }

      EXPECT_NEAR(sum / area(faces[i]), 1, 1e-11) << degrees << " face " << i;
    }
  }
}

Corners random_triangle(std::mt19937& random) {
  std::uniform_real_distribution<double> coordinate(-1, 1);
  Corners corners(3);
  for (Vec3& x : corners) x = Vec3(coordinate(random), coordinate(random), coordinate(random));
  return corners;
}

// Straddling, near and far pairs in any position.
TEST(ExchangeArea, AddsUpUnderSubdivision) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 200; ++trial) {
    const Corners a = random_triangle(random), b = random_triangle(random);
    const Vec3 middle = 0.3 * a[0] + 0.7 * a[1];

    const double whole = exchange_area(a, b);
    const double parts =
        exchange_area(Corners{a[0], middle, a[2]}, b) + exchange_area(Corners{middle, a[1], a[2]}, b);

    // triangles that cross see each other at any distance down to 0
    EXPECT_NEAR(parts, whole, 1e-11 * std::min(area(a), area(b))) << trial;
  }
}

TEST(ExchangeArea, IsTheSameSeenFromTheOtherSide) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 200; ++trial) {
    const Corners a = random_triangle(random), b = random_triangle(random);

    const double there = exchange_area(a, b), back = exchange_area(b, a);

    EXPECT_NEAR(there, back, 1e-12 * std::min(area(a), area(b))) << trial;
    EXPECT_GE(there, 0);
    EXPECT_LE(there, std::min(area(a), area(b)) * (1 + 1e-12));
  }
}

TEST(ExchangeArea, DoesNotDependOnUnitAndPlace) {
  const Corners a = level(0, 1, 0, 1, 0), b = upright(0.5, 1.5, 0, 1);
  const double exchange = exchange_area(a, b);
  for (const double scale : {1e-6, 1e6}) {
    Corners p = a, q = b;
    for (Vec3& x : p) x = scale * x;
    for (Vec3& x : q) x = scale * x;

    EXPECT_NEAR(exchange_area(p, q) / (exchange * scale * scale), 1, 1e-13) << scale;
  }
  for (const double offset : {1e6, 1e8}) {
    Corners p = a, q = b;
    for (Vec3& x : p) x += Vec3(offset, -offset, 0.5 * offset);
    for (Vec3& x : q) x += Vec3(offset, -offset, 0.5 * offset);

    // the corners themselves are binary fractions here, so that nothing is lost
    EXPECT_NEAR(exchange_area(p, q) / exchange, 1, 1e-13) << offset;
  }
}

TEST(ExchangeArea, RejectsWhatIsNoPolygon) {
  EXPECT_THROW(exchange_area(Corners(2, Vec3::Zero()), level(0, 1, 0, 1, 0)), std::invalid_argument);
  EXPECT_THROW(exchange_area(level(0, 1, 0, 1, 0), Corners(9, Vec3::Zero())), std::invalid_argument);
}

// Howell's catalogue B-3, B-4: differential element to rectangle, evaluated in high precision.
TEST(PointFormFactor, AgreesWithClosedForms) {
  const Corners square = flipped(level(0, 1, 0, 1, 1));
  EXPECT_NEAR(point_form_factor({0, 0, 0}, Vec3::UnitZ(), square), 0.13853160599, 1e-11);
  EXPECT_NEAR(point_form_factor({0.5, 0.5, 0}, Vec3::UnitZ(), square), 0.23945647046, 1e-11);
  EXPECT_NEAR(point_form_factor({0, 0, 0}, Vec3::UnitX(), square), 0.055734197003, 1e-12);
  EXPECT_NEAR(point_form_factor({0.3, 0.3, 0}, Vec3::UnitZ(), flipped(level(0, 1, 0, 1, 1e-3))),
              0.99999435829375, 1e-13);
}

TEST(PointFormFactor, ClipsByTheHorizon) {
  const Corners square{{1, -1, -1}, {1, -1, 1}, {1, 1, 1}, {1, 1, -1}};

  EXPECT_NEAR(point_form_factor({0, 0, 0}, Vec3::UnitZ(), square), 0.11146839401, 1e-11);
  EXPECT_EQ(point_form_factor({2, 0, 0}, Vec3::UnitZ(), square), 0);
}

}  // namespace
}  // namespace luxel
