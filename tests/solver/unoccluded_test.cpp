#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <random>

#include "luxel/form_factors.h"
#include "luxel/input_error.h"
#include "solver/closed_meshes.h"
#include "solver/hand_made_mesh.h"

// form_factors() where nothing hides anything.
namespace luxel {
namespace {

using testing::box;
using testing::moved;
using testing::odd_rotation;
using testing::patch_mesh;
using testing::renumbered;

struct RowErrors {
  double max = 0, rms = 0;
};

// |row sum - 1|, largest and area-weighted root mean square.
RowErrors row_errors(const PatchMesh& mesh, const ExchangeMatrix& exchange) {
  RowErrors errors;
  double squares = 0, total = 0;
  for (int i = 0; i < mesh.size(); ++i) {
    double sum = 0;
    for (int j = 0; j < mesh.size(); ++j) sum += exchange(i, j);
    const double error = std::abs(sum / mesh.areas[i] - 1);
    errors.max = std::max(errors.max, error);
    squares += mesh.areas[i] * error * error;
    total += mesh.areas[i];
  }
  errors.rms = std::sqrt(squares / total);
  return errors;
}

FormFactors at_accuracy(const PatchMesh& mesh, double accuracy, Precision precision = Precision::float32) {
  FormFactorOptions options;
  options.accuracy = accuracy;
  options.precision = precision;
  return form_factors(mesh, options);
}

// Largest |F_ij - F_ij'| where patch k of `other` is patch order[k] of `mesh`; exchange areas of `other` are
// in units `square` times larger.
double largest_difference(const PatchMesh& mesh, const ExchangeMatrix& a, const ExchangeMatrix& b,
                          const std::vector<int>& order, double square) {
  double largest = 0;
  for (int i = 0; i < mesh.size(); ++i) {
    for (int j = 0; j < i; ++j) {
      const double there = b(i, j) / square, here = a(order[i], order[j]);
      largest =
          std::max(largest, std::abs(there - here) / std::min(mesh.areas[order[i]], mesh.areas[order[j]]));
    }
  }
  return largest;
}

std::vector<int> same_order(const PatchMesh& mesh) {
  std::vector<int> order(mesh.size());
  std::iota(order.begin(), order.end(), 0);
  return order;
}

struct Shape {
  const char* name;
  PatchMesh mesh;
};

std::vector<Shape> closed_shapes() {
  std::vector<Shape> shapes;
  shapes.push_back({"one quad a side", box(1, false)});
  shapes.push_back({"cube", box(9, false)});
  shapes.push_back({"rotated cube", moved(box(8, false), odd_rotation(), 1, Vec3::Zero())});
  shapes.push_back({"triangles", box(7, true)});
  shapes.push_back({"rotated triangles", moved(box(5, true), odd_rotation(), 1, Vec3::Zero())});
  shapes.push_back({"prism", box(8, false, Vec3(1, 2, 0.3))});
  shapes.push_back({"two plates", box(8, false, Vec3(1, 1, 0.05))});
  shapes.push_back({"shaft", box(7, true, Vec3(1, 1, 6))});
  // both kinds of patches in one mesh
  PatchMesh mixed = box(6, false);
  std::vector<std::array<int, 4>> corners;
  for (int p = 0; p < mixed.size(); ++p) {
    const auto c = mixed.corners[p];
    if (p % 3 == 0) {
      corners.push_back({c[0], c[1], c[2], -1});
      corners.push_back({c[0], c[2], c[3], -1});
    } else {
      corners.push_back(c);
    }
  }
  shapes.push_back({"mixed", patch_mesh(mixed.vertices, corners)});
  return shapes;
}

TEST(Unoccluded, ObeysTheAccuracy) {
  for (const Shape& shape : closed_shapes()) {
    for (const double accuracy : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
      const FormFactors factors = at_accuracy(shape.mesh, accuracy, Precision::float64);

      const RowErrors errors = row_errors(shape.mesh, factors.exchange_areas);
      EXPECT_LE(errors.rms, accuracy) << shape.name << " " << accuracy;
      EXPECT_LE(errors.max, 2 * accuracy) << shape.name << " " << accuracy;
    }
  }
}

// Regular tetrahedra have F = 1/3 exactly; the others close.
TEST(Unoccluded, ClosesConvexPolyhedra) {
  const PatchMesh tetrahedron = patch_mesh({{-1, 1, -1}, {1, -1, -1}, {1, 1, 1}, {-1, -1, 1}},
                                           {{0, 1, 2, -1}, {1, 3, 2, -1}, {3, 0, 2, -1}, {0, 3, 1, -1}});

  const FormFactors factors = at_accuracy(tetrahedron, 1e-8, Precision::float64);

  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < i; ++j)
      EXPECT_NEAR(factors.exchange_areas(i, j) / tetrahedron.areas[i], 1.0 / 3, 1e-9);
  }
}

// Hexahedra with planar faces: a box under random affine maps.
TEST(Unoccluded, ClosesSkewedBoxes) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-0.6, 0.6);
  for (int trial = 0; trial < 5; ++trial) {
    Eigen::Matrix3d skew = Eigen::Matrix3d::Identity();
    for (int k = 0; k < 9; ++k) skew(k) += unit(random);
    if (skew.determinant() < 0.1) continue;
    const PatchMesh mesh = moved(box(5, trial % 2 == 0), skew, 1, Vec3::Zero());

    const RowErrors errors = row_errors(mesh, at_accuracy(mesh, 1e-5).exchange_areas);

    EXPECT_LE(errors.rms, 1e-5) << trial;
    EXPECT_LE(errors.max, 2e-5) << trial;
  }
}

TEST(Unoccluded, AddsUpUnderSubdivision) {
  const PatchMesh coarse = box(1, false), fine = box(6, false);

  const ExchangeMatrix whole = at_accuracy(coarse, 1e-6, Precision::float64).exchange_areas;
  const ExchangeMatrix parts = at_accuracy(fine, 1e-6, Precision::float64).exchange_areas;

  for (int a = 0; a < 6; ++a) {
    for (int b = 0; b < a; ++b) {
      double sum = 0;
      for (int i = 36 * a; i < 36 * (a + 1); ++i) {
        for (int j = 36 * b; j < 36 * (b + 1); ++j) sum += parts(i, j);
      }
      // group factors to A
      EXPECT_NEAR(sum, whole(a, b), 2e-6) << a << " " << b;
    }
  }
}

// Group to group in a closed cube: 0.199824895698387 opposite (Howell C-11), 0.200043776075403 beside (C-14).
TEST(Unoccluded, GivesTheFactorsOfTheCube) {
  const ExchangeMatrix exchange = at_accuracy(box(1, false), 1e-8, Precision::float64).exchange_areas;

  EXPECT_NEAR(exchange(1, 0), 0.199824895698387, 1e-10);
  EXPECT_NEAR(exchange(2, 0), 0.200043776075403, 1e-10);
}

TEST(Unoccluded, DoesNotDependOnPlaceAndUnit) {
  const PatchMesh mesh = box(5, true);
  const ExchangeMatrix here = at_accuracy(mesh, 1e-6, Precision::float64).exchange_areas;
  for (const double scale : {1e-6, 1.0, 1e6}) {
    const PatchMesh there = moved(mesh, odd_rotation(), scale, scale * Vec3(3, 4, 5));

    const ExchangeMatrix exchange = at_accuracy(there, 1e-6, Precision::float64).exchange_areas;

    // each is right to A, and the tree differs
    EXPECT_LE(largest_difference(mesh, here, exchange, same_order(mesh), scale * scale), 1e-6) << scale;
  }
}

TEST(Unoccluded, StandsOffsetsOfAHundredMillion) {
  for (const double offset : {1e6, 1e8}) {
    // corners at multiples of 1/8 are exact at this offset
    const PatchMesh mesh =
        moved(box(8, false), Eigen::Matrix3d::Identity(), 1, Vec3(offset, offset, -offset));

    const RowErrors errors = row_errors(mesh, at_accuracy(mesh, 1e-6).exchange_areas);

    EXPECT_LE(errors.max, 2e-6) << offset;
  }
}

TEST(Unoccluded, DoesNotDependOnTheNumbering) {
  const PatchMesh mesh = box(6, false);
  std::vector<int> order = same_order(mesh);
  std::shuffle(order.begin(), order.end(), std::mt19937(1));

  const ExchangeMatrix here = at_accuracy(mesh, 1e-6, Precision::float64).exchange_areas;
  const ExchangeMatrix there = at_accuracy(renumbered(mesh, order), 1e-6, Precision::float64).exchange_areas;

  EXPECT_LE(largest_difference(mesh, here, there, order, 1), 1e-6);
}

// Two walls that pass through each other's plane: the clipped parts only.
TEST(Unoccluded, ClipsPairsThatStraddle) {
  const PatchMesh mesh = patch_mesh({{-1, 0, 0},
                                     {1, 0, 0},
                                     {1, 1, 0},
                                     {-1, 1, 0},
                                     {0, 0.2, -0.5},
                                     {0, 0.7, -0.5},
                                     {0, 0.7, 0.6},
                                     {0, 0.2, 0.6}},
                                    {{0, 1, 2, 3}, {4, 5, 6, 7}});
  const std::vector<Vec3> floor{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
      wall{{0, 0.2, 0}, {0, 0.7, 0}, {0, 0.7, 0.6}, {0, 0.2, 0.6}};

  const ExchangeMatrix exchange = at_accuracy(mesh, 1e-8, Precision::float64).exchange_areas;

  EXPECT_NEAR(exchange(1, 0), exchange_area(floor, wall), 1e-9);
}

TEST(Unoccluded, LeavesPairsThatDoNotFaceAtZero) {
  const PatchMesh mesh =
      patch_mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
                 {{0, 1, 2, 3}, {4, 5, 6, 7}});

  const FormFactors factors = at_accuracy(mesh, 1e-3);

  EXPECT_EQ(factors.exchange_areas(1, 0), 0);
  EXPECT_EQ(factors.report.facing_pairs, 0);
  EXPECT_EQ(factors.report.pairs, 1);
}

TEST(Unoccluded, BoundsHold) {
  const PatchMesh mesh = box(4, true, Vec3(1, 1, 0.01));

  const ExchangeMatrix exchange = at_accuracy(mesh, 1e-4).exchange_areas;

  for (int i = 0; i < mesh.size(); ++i) {
    for (int j = 0; j < i; ++j) {
      EXPECT_GE(exchange(i, j), 0);
      EXPECT_LE(exchange(i, j), std::min(mesh.areas[i], mesh.areas[j]) * (1 + 1e-4));
    }
  }
}

TEST(Unoccluded, CountsFacingPairsOfTheCube) {
  const FormFactors factors = at_accuracy(box(4, false), 1e-3);

  EXPECT_EQ(factors.report.pairs, 96 * 95 / 2);
  EXPECT_EQ(factors.report.facing_pairs, 15 * 16 * 16);
}

TEST(Unoccluded, EstimatesItsError) {
  for (const double accuracy : {1e-3, 1e-5}) {
    const PatchMesh mesh = box(10, false);

    const FormFactors factors = at_accuracy(mesh, accuracy);

    const RowErrors errors = row_errors(mesh, factors.exchange_areas);
    EXPECT_LE(factors.report.estimated_error, accuracy);
    // the estimate is a mean over the rules' bounds, not a bound of each row
    EXPECT_GE(factors.report.estimated_error, 0.2 * errors.rms);
  }
}

TEST(Unoccluded, GivesTheSameBitsForAnyNumberOfThreads) {
  for (const PatchMesh& mesh : {box(12, false), box(7, true)}) {
    auto with_threads = [&](int threads) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      return at_accuracy(mesh, 1e-5);
    };

    const FormFactors one = with_threads(1), two = with_threads(2);

    EXPECT_EQ(std::memcmp(one.exchange_areas.row<float>(1), two.exchange_areas.row<float>(1),
                          one.exchange_areas.bytes()),
              0);
    EXPECT_EQ(one.report.estimated_error, two.report.estimated_error);
    EXPECT_EQ(one.report.facing_pairs, two.report.facing_pairs);
  }
}

TEST(Unoccluded, ReportsItsProgressToTheEnd) {
  double last = 0, total = 0;
  bool rising = true;
  form_factors(box(8, false), {}, [&](std::string_view, double done, double all) {
    rising = rising && done >= last;
    last = done;
    total = all;
    return true;
  });

  EXPECT_TRUE(rising);
  EXPECT_GT(total, 0);
  EXPECT_EQ(last, total);
}

TEST(Unoccluded, StopsWhenAsked) {
  auto stop = [](std::string_view, double, double) { return false; };

  EXPECT_THROW(form_factors(box(8, false), {}, stop), Cancelled);
}

TEST(Unoccluded, RejectsAnAccuracyOutOfRange) {
  FormFactorOptions options;
  for (const double accuracy : {0.0, 1e-9, 0.2, std::nan("")}) {
    options.accuracy = accuracy;

    EXPECT_THROW(form_factors(box(1, false), options), std::invalid_argument) << accuracy;
  }
}

TEST(Unoccluded, TakesMeshesOfNoAndOnePatch) {
  EXPECT_EQ(form_factors(PatchMesh{}).exchange_areas.size(), 0);
  EXPECT_EQ(
      form_factors(patch_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2, -1}})).exchange_areas.size(), 1);
}

// A thin panel has a front and a back in one plane, and the back shares a cluster with a sheet before the
// panel that looks the same way. Enough else is there that clusters are looked at whole.
TEST(Unoccluded, NothingGoesBetweenTheTwoSidesOfAPanel) {
  std::vector<Vec3> vertices{{0, 0, 0},     {1, 0, 0},     {1, 0, 1},     {0, 0, 1},
                             {0, -0.25, 0}, {1, -0.25, 0}, {1, -0.25, 1}, {0, -0.25, 1}};
  std::vector<std::array<int, 4>> faces{
      {0, 1, 2, -1}, {0, 2, 3, -1}, {3, 2, 1, -1}, {3, 1, 0, -1}, {7, 6, 5, 4}};
  for (int i = 0; i < 20; ++i) {
    for (int k = 0; k < 20; ++k) {
      const int first = static_cast<int>(vertices.size());
      vertices.insert(vertices.end(),
                      {Vec3(i, 9, k), Vec3(i + 1, 9, k), Vec3(i + 1, 9, k + 1), Vec3(i, 9, k + 1)});
      faces.push_back({first, first + 1, first + 2, first + 3});
    }
  }
  const PatchMesh mesh = testing::hand_made_mesh(vertices, faces);

  const ExchangeMatrix exchange = at_accuracy(mesh, 1e-4).exchange_areas;

  for (const int front : {0, 1}) {
    EXPECT_EQ(exchange(front, 2), 0);
    EXPECT_EQ(exchange(front, 3), 0);
    EXPECT_GT(exchange(front, 4), 0.1);
  }
}

}  // namespace
}  // namespace luxel
