#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "luxel/form_factors.h"
#include "luxel/input_error.h"
#include "solver/blocked_scenes.h"

namespace luxel {
namespace {

using testing::SceneBuilder;
using testing::turned;

FormFactors factors(const PatchMesh& mesh, double accuracy, Visibility visibility = Visibility::automatic) {
  FormFactorOptions options;
  options.accuracy = accuracy;
  options.visibility = visibility;
  options.precision = Precision::float64;
  return form_factors(mesh, options);
}

double exchange(const FormFactors& f, int begin_i, int end_i, int begin_j, int end_j) {
  double sum = 0;
  for (int i = begin_i; i < end_i; ++i) {
    for (int j = begin_j; j < end_j; ++j) sum += f.exchange_areas(i, j);
  }
  return sum;
}

struct RowErrors {
  double max = 0, rms = 0;
};
// of rows of a closed scene
RowErrors row_errors(const FormFactors& f, const PatchMesh& mesh) {
  RowErrors errors;
  double total = 0;
  for (int i = 0; i < mesh.size(); ++i) {
    double sum = 0;
    for (int j = 0; j < mesh.size(); ++j) sum += f.exchange_areas(i, j);
    const double error = sum / mesh.areas[i] - 1;
    errors.max = std::max(errors.max, std::abs(error));
    errors.rms += error * error * mesh.areas[i];
    total += mesh.areas[i];
  }
  errors.rms = std::sqrt(errors.rms / total);
  return errors;
}

// Unit squares at distance h that face each other in k x k patches, and a sheet in between.
PatchMesh facing_squares(double h, int k, const std::vector<std::vector<Vec3>>& sheets) {
  SceneBuilder scene;
  scene.quad({-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0}, k);
  scene.quad({-0.5, -0.5, h}, {-0.5, 0.5, h}, {0.5, 0.5, h}, {0.5, -0.5, h}, k);
  for (const auto& corners : sheets) {
    scene.patch(corners, scene.polygon(corners));
  }
  return scene.take();
}
std::vector<Vec3> sheet(double cx, double cy, double half_x, double half_y, double z) {
  return {{cx - half_x, cy - half_y, z},
          {cx + half_x, cy - half_y, z},
          {cx + half_x, cy + half_y, z},
          {cx - half_x, cy + half_y, z}};
}

struct Blocked {
  double distance, cx, cy, half_x, half_y, z, factor;
};

// A rectangle between two unit squares. Mid-plane: view-factor algebra on the aligned rectangles of Howell
// C-11; others: reduction to a two-dimensional integral with piecewise linear weights, 12 digits.
class BlockedSquares : public ::testing::TestWithParam<std::tuple<Blocked, int>> {};

TEST_P(BlockedSquares, HaveTheExactFactor) {
  const auto& [blocked, k] = GetParam();
  const PatchMesh mesh = facing_squares(
      blocked.distance, k, {sheet(blocked.cx, blocked.cy, blocked.half_x, blocked.half_y, blocked.z)});

  for (double accuracy : {1e-3, 1e-5, 1e-7}) {
    const FormFactors f = factors(mesh, accuracy, Visibility::exact);

    EXPECT_NEAR(exchange(f, 0, k * k, k * k, 2 * k * k), blocked.factor, accuracy);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Cases, BlockedSquares,
    ::testing::Combine(::testing::Values(Blocked{1, 0, 0, 0.25, 0.25, 0.5, 0.09950629459898},
                                         Blocked{0.5, 0, 0, 0.125, 0.125, 0.25, 0.3660372452012},
                                         Blocked{1, 0, 0, 0.25, 0.25, 0.25, 0.115620602132},
                                         Blocked{1, 0.2, -0.1, 0.25, 0.15, 0.5, 0.149823761368}),
                       ::testing::Values(1, 3)));

TEST(Visibility, IsExactlyZeroBehindASheetOfTheSameSize) {
  const PatchMesh mesh = facing_squares(1, 3, {sheet(0, 0, 0.5, 0.5, 0.5)});

  for (Visibility way : {Visibility::exact, Visibility::rays, Visibility::automatic}) {
    EXPECT_EQ(exchange(factors(mesh, 1e-3, way), 0, 9, 9, 18), 0);
  }
}

TEST(Visibility, LeavesASheetItsOwnViewOfWhatItHides) {
  SceneBuilder scene;
  scene.quad({-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0}, 1);
  scene.quad({-0.5, -0.5, 1}, {-0.5, 0.5, 1}, {0.5, 0.5, 1}, {0.5, -0.5, 1}, 1);
  scene.quad({-0.5, -0.5, 0.5}, {0.5, -0.5, 0.5}, {0.5, 0.5, 0.5}, {-0.5, 0.5, 0.5}, 1, 2);
  const PatchMesh mesh = scene.take();
  for (Visibility way : {Visibility::exact, Visibility::rays}) {
    const FormFactors f = factors(mesh, 1e-6, way);

    EXPECT_EQ(f.exchange_areas(0, 1), 0);
    // parallel unit squares at distance 1/2, Howell C-11
    EXPECT_NEAR(f.exchange_areas(0, 3), 0.4152532835771, 1e-6);
    EXPECT_NEAR(f.exchange_areas(1, 2), 0.4152532835771, 1e-6);
  }
}

TEST(Visibility, OfATriangleIsHalfThatOfItsParallelogram) {
  const std::vector<Vec3> square = sheet(0, 0, 0.25, 0.25, 0.5);
  const PatchMesh mesh = facing_squares(1, 1, {{square[0], square[1], square[2]}});

  const double visible = factors(mesh, 1e-7).exchange_areas(0, 1);

  // both halves hide the same by symmetry, and together what the square hides
  EXPECT_NEAR(visible, (0.1998248956984 + 0.09950629459898) / 2, 1e-7);
}

TEST(Visibility, GivesTheLShapedRoomOfPinneyAndBean) {
  SceneBuilder scene;
  auto wall = [&](const Vec3& a, const Vec3& b) {  // seen from the right of a - b
    scene.quad(a, b, b + Vec3(0, 0, 3), a + Vec3(0, 0, 3), 1);
  };
  wall({3, 0, 0}, {0, 0, 0});
  wall({3, 1, 0}, {3, 0, 0});
  wall({1, 1, 0}, {3, 1, 0});
  wall({1, 3, 0}, {1, 1, 0});
  wall({0, 3, 0}, {1, 3, 0});
  wall({0, 0, 0}, {0, 3, 0});
  const std::vector<Vec3> plan{{1, 1, 0}, {1, 3, 0}, {0, 3, 0}, {0, 0, 0}, {3, 0, 0}, {3, 1, 0}};
  for (double z : {3.0, 0.0}) {
    auto lifted = [&](std::vector<Vec3> corners) {
      for (Vec3& x : corners) x.z() = z;
      if (z > 0) std::reverse(corners.begin(), corners.end());
      return corners;
    };
    std::vector<Vec3> outline = lifted(plan);
    std::rotate(outline.begin(), std::find(outline.begin(), outline.end(), Vec3(1, 1, z)), outline.end());
    const int polygon = scene.polygon(outline);
    scene.patch(lifted({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}), polygon);
    scene.patch(lifted({{1, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}}), polygon);
    scene.patch(lifted({{0, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}}), polygon);
  }
  const PatchMesh mesh = scene.take();

  const FormFactors f = factors(mesh, 1e-7, Visibility::exact);

  // where patches as large as the room touch the corner that hides, clipping is good to 5e-7, not to 1e-7;
  // Pinney and Bean 1988, test 4, recomputed; rows of surfaces 1, 2 and 7
  const std::array<double, 8> first{0.0,
                                    0.11315441430358,
                                    0.37809289779935,
                                    0.027473405707512,
                                    0.032890247563088,
                                    0.18235590366860,
                                    0.13301656547894,
                                    0.13301656547894};
  const std::array<int, 9> begin{0, 1, 2, 3, 4, 5, 6, 9, 12};
  for (int j = 1; j < 8; ++j) EXPECT_NEAR(exchange(f, 0, 1, begin[j], begin[j + 1]) / 9, first[j], 1e-6);
  EXPECT_NEAR(f.exchange_areas(1, 5) / 3, 0.098670742689264, 1e-6);
  EXPECT_NEAR(exchange(f, 6, 9, 9, 12) / 5, 0.096836143723043, 1e-6);
  EXPECT_LT(row_errors(f, mesh).max, 1e-6);
}

TEST(Visibility, SharesTheLightOfNestedCubesAsAreasSay) {
  SceneBuilder scene;
  scene.box({0, 0, 0}, {1, 1, 1}, Eigen::Matrix3d::Identity(), 4, true);
  scene.box({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}, turned(0.2, 0.1, 0.4), 3, false);
  const PatchMesh mesh = scene.take();
  const int outer = 6 * 16, all = outer + 6 * 9;

  for (double accuracy : {1e-3, 1e-5}) {
    const FormFactors f = factors(mesh, accuracy);

    EXPECT_NEAR(exchange(f, outer, all, 0, outer) / 1.5, 1, accuracy);
    EXPECT_NEAR(exchange(f, 0, outer, 0, outer) / 6, 0.75, accuracy);
    EXPECT_EQ(exchange(f, outer, all, outer, all), 0);
  }
}

TEST(Visibility, LeavesNothingThroughAWall) {
  for (double thickness : {1e-3, 1e-6}) {
    SceneBuilder scene;
    scene.box({0, 0, 0}, {1, 1, 1}, Eigen::Matrix3d::Identity(), 3, true);
    scene.box({1 + thickness, 0, 0}, {2 + thickness, 1, 1}, Eigen::Matrix3d::Identity(), 3, true);
    const PatchMesh mesh = scene.take();
    for (Visibility way : {Visibility::exact, Visibility::rays}) {
      const FormFactors f = factors(mesh, 1e-3, way);

      EXPECT_EQ(exchange(f, 0, 54, 54, 108), 0) << "wall of " << thickness;
      EXPECT_LT(row_errors(f, mesh).max, 2e-3);
    }
  }
}

TEST(Visibility, ClosesRoomsWithBoxesToTheAccuracyAsked) {
  const PatchMesh upright = testing::room_with_box(6, 3),
                  turned_boxes = testing::room_with_turned_boxes(6, 3);
  for (double accuracy : {1e-2, 1e-3, 1e-4, 1e-5}) {
    for (const PatchMesh* mesh : {&upright, &turned_boxes}) {
      const RowErrors errors = row_errors(factors(*mesh, accuracy), *mesh);

      EXPECT_LE(errors.rms, accuracy);
      EXPECT_LE(errors.max, 2 * accuracy);
    }
  }
}

TEST(Visibility, ClosesRoomsWithRoundBodiesToTheAccuracyAsked) {
  // two prisms, planes of whose sides and ends run through each other; the box beside them overlaps their
  // shadows
  SceneBuilder scene;
  scene.box({0, 0, 0}, {1, 1, 1}, Eigen::Matrix3d::Identity(), 2, true);
  scene.prism({0.2, 0.3, 0.3}, {0.45, 0.4, 0.5}, 0.12, 17);
  scene.prism({0.5, 0.75, 0.15}, {0.55, 0.7, 0.85}, 0.1, 18);
  scene.box({0.7, 0.2, 0.4}, {0.85, 0.4, 0.7}, turned(0.3, 0.5, 0.7), 2, false);
  const PatchMesh mesh = scene.take();
  for (double accuracy : {1e-2, 1e-3, 1e-5}) {
    const RowErrors errors = row_errors(factors(mesh, accuracy), mesh);

    EXPECT_LE(errors.rms, accuracy);
    EXPECT_LE(errors.max, 2 * accuracy);
  }
}

TEST(Visibility, ClosesARoomWithABoxOnItsUnsplitFloor) {
  SceneBuilder scene;
  scene.box({0, 0, 0}, {1, 1, 1}, Eigen::Matrix3d::Identity(), 5, true);
  scene.box({0.2, 0.2, 0}, {0.6, 0.6, 0.5}, Eigen::Matrix3d::Identity(), 2, false);
  const PatchMesh mesh = scene.take();

  const FormFactors f = factors(mesh, 1e-5);

  // patches of the floor under the box and of its bottom see nothing; part of none is covered here
  int dark = 0;
  for (int i = 0; i < mesh.size(); ++i) {
    const double sum = exchange(f, i, i + 1, 0, mesh.size()) / mesh.areas[i];
    if (mesh.centroids[i].z() == 0 && std::abs(mesh.centroids[i].x() - 0.4) < 0.2 &&
        std::abs(mesh.centroids[i].y() - 0.4) < 0.2) {
      EXPECT_LE(sum, 1e-9);
      ++dark;
    } else {
      EXPECT_NEAR(sum, 1, 2e-5) << mesh.centroids[i].transpose();
    }
  }
  EXPECT_EQ(dark, 4 + 4);
}

// A cube full of small two-sided sheets, each in a cell of its own: so many that rays sort the blocks.
PatchMesh room_with_leaves() {
  SceneBuilder scene;
  scene.box({0, 0, 0}, {1, 1, 1}, Eigen::Matrix3d::Identity(), 6, true);
  for (int k = 0; k < 64; ++k) {
    const Vec3 centre = Vec3(k % 4 + 0.5, k / 4 % 4 + 0.5, k / 16 + 0.5) / 4;
    const Eigen::Matrix3d turn = turned(0.7 * k, 1.1 * k, 1.9 * k);
    const Vec3 u = 0.07 * turn.col(0), v = 0.05 * turn.col(1);
    scene.quad(centre - u - v, centre + u - v, centre + u + v, centre - u + v, 1, 2);
  }
  return scene.take();
}

TEST(Visibility, ClosesARoomFullOfLeavesToTheAccuracyAsked) {
  const PatchMesh mesh = room_with_leaves();

  for (double accuracy : {1e-2, 1e-3}) {
    const FormFactors f = factors(mesh, accuracy);

    const RowErrors errors = row_errors(f, mesh);
    EXPECT_LE(errors.rms, accuracy);
    EXPECT_LE(errors.max, 2 * accuracy);
    EXPECT_GT(f.report.rays, 0);
  }
}

// Where little accuracy is asked, a ray or two measure a pair, and hardly any is clipped.
TEST(Visibility, TakesFewRaysWhereLittleIsAsked) {
  const PatchMesh boxes = testing::room_with_turned_boxes(10, 5), leaves = room_with_leaves();
  for (const auto& [mesh, accuracy] : {std::pair(&boxes, 0.1), {&boxes, 0.03}, {&leaves, 0.1}}) {
    const FormFactors f = factors(*mesh, accuracy);

    EXPECT_LT(f.report.exact_pairs, f.report.facing_pairs / 20);
    EXPECT_LT(f.report.rays, 3 * f.report.facing_pairs);
    const RowErrors errors = row_errors(f, *mesh);
    EXPECT_LE(errors.rms, accuracy);
    EXPECT_LE(errors.max, 2 * accuracy);
  }
}

TEST(Visibility, CutsTheFloorWhereAWallStandsOnIt) {
  // the patch that looks on may be smaller or larger than the floor: either of the two is then the one that
  // is cut
  for (double size : {0.5, 4.0}) {
    SceneBuilder scene;
    scene.placement.rotate(turned(0.7, 0.4, -0.9));
    const std::vector<Vec3> looking{{3, -size, 1}, {3, -size, 1 + size}, {3, size, 1 + size}, {3, size, 1}};
    const std::vector<Vec3> floor{{-0.4, -1, 0}, {2, -1, 0}, {2, 1, 0}, {-0.4, 1, 0}};
    const std::vector<Vec3> before_wall{{0.3, -1, 0}, {2, -1, 0}, {2, 1, 0}, {0.3, 1, 0}};
    const std::vector<Vec3> wall{{0.3, -9, 0}, {0.3, 9, 0}, {0.3, 9, 9}, {0.3, -9, 9}};
    for (const auto& corners : {looking, floor, wall}) scene.patch(corners, scene.polygon(corners));

    const FormFactors f = factors(scene.take(), 1e-6, Visibility::exact);

    const double seen = exchange_area(looking, before_wall);
    EXPECT_NEAR(f.exchange_areas(0, 1), seen, 1e-6 * seen) << size;
  }
}

TEST(Visibility, LeavesFloorUnderABoxItsUncoveredPart) {
  SceneBuilder scene;
  scene.placement.rotate(turned(0.2, 0.4, -0.9));
  scene.box({0, 0, 0}, {1, 1, 1}, Eigen::Matrix3d::Identity(), 3, true);
  scene.box({0.25, 0.2, 0}, {0.6, 0.7, 0.5}, Eigen::Matrix3d::Identity(), 2, false);
  const PatchMesh mesh = scene.take();

  const FormFactors f = factors(mesh, 1e-5);

  for (int i = 0; i < mesh.size(); ++i) {
    const Vec3 centre = scene.placement.inverse() * mesh.centroids[i];
    double expected = 1;
    if (std::abs(centre.z()) < 1e-9) {
      // of the floor what the box leaves free; of the box's bottom nothing
      const auto covered = [](double middle, double low, double high) {
        return std::max(0.0, std::min(middle + 1.0 / 6, high) - std::max(middle - 1.0 / 6, low));
      };
      expected = 1 - 9 * covered(centre.x(), 0.25, 0.6) * covered(centre.y(), 0.2, 0.7);
      if (i >= 54) expected = 0;
    }
    EXPECT_NEAR(exchange(f, i, i + 1, 0, mesh.size()) / mesh.areas[i], expected, 2e-5) << centre.transpose();
  }
}

TEST(Visibility, KeepsTheInsideOfABoxApartFromItsOutside) {
  SceneBuilder scene;
  scene.box({0, 0, 0}, {1, 1, 1}, Eigen::Matrix3d::Identity(), 3, true);
  scene.box({0.3, 0.35, 0.4}, {0.7, 0.6, 0.8}, turned(0.3, 0.2, 0.1), 2, false, 2);
  const PatchMesh mesh = scene.take();

  const FormFactors f = factors(mesh, 1e-5);

  EXPECT_LT(row_errors(f, mesh).max, 2e-5);
  for (int i = 54; i < mesh.size(); ++i) {
    const double out = exchange(f, i, i + 1, 0, 54);
    const double in = exchange(f, i, i + 1, 54, mesh.size());
    EXPECT_LE(std::min(out, in), 1e-5 * mesh.areas[i]);
  }
}

TEST(Visibility, ClosesARoomWithThinTiltedSheets) {
  SceneBuilder scene;
  scene.box({0, 0, 0}, {1, 1, 1}, Eigen::Matrix3d::Identity(), 4, true);
  scene.quad({0.2, 0.3, 0.3}, {0.8, 0.25, 0.45}, {0.8, 0.65, 0.7}, {0.2, 0.7, 0.55}, 3, 2);
  const PatchMesh mesh = scene.take();

  EXPECT_LT(row_errors(factors(mesh, 1e-5), mesh).max, 2e-5);
}

// The floor in front of a slanted wall meets it in an edge whose corners are off the wall's plane by the
// noise of six digits, to one side or the other; the wall stands in the way of what lies behind it only.
TEST(Visibility, IsNotTakenFromAFloorByTheWallAtWhoseFootItEnds) {
  const Vec3 left(0.1, 0.2, 0), right(0.7, 0.45, 0), up(0, 0, 0.6);
  const Vec3 away = (right - left).cross(up).normalized();
  for (const double noise : {-3e-9, 3e-9, -3e-10}) {
    SceneBuilder scene;
    const std::vector<Vec3> wall{left, right, right + up, left + up};
    const std::vector<Vec3> front{0.5 * (left + right) + noise * away, left + 0.2 * (right - left),
                                  0.5 * (left + right) + 0.2 * away};
    const std::vector<Vec3> behind{left, right, left - 0.3 * away};
    const std::vector<Vec3> opposite{Vec3(0.9, -0.4, 0.3), Vec3(0.6, -0.6, 0.3), Vec3(0.75, -0.5, 0.6)};
    for (const auto& patch : {front, behind, opposite, wall}) scene.patch(patch, scene.polygon(patch));
    const PatchMesh mesh = scene.take();
    const double in_sight = exchange_area(front, opposite);
    ASSERT_GT(in_sight, 0);

    const FormFactors found = factors(mesh, 1e-6, Visibility::exact);

    EXPECT_GT(found.report.occluders, 0);
    EXPECT_NEAR(found.exchange_areas(0, 2) / in_sight, 1, 1e-6) << "noise " << noise;
    EXPECT_EQ(found.exchange_areas(1, 2), 0);
  }
}

TEST(Visibility, OnlyFallsWhenOccludersAreAdded) {
  const std::vector<Vec3> first = sheet(0, 0, 0.25, 0.25, 0.5), second = sheet(0.2, -0.1, 0.25, 0.15, 0.3);
  const FormFactors none = factors(facing_squares(1, 3, {}), 1e-6);
  const FormFactors one = factors(facing_squares(1, 3, {first}), 1e-6);
  const FormFactors two = factors(facing_squares(1, 3, {first, second}), 1e-6);

  for (int i = 0; i < 18; ++i) {
    for (int j = 0; j < i; ++j) {
      // both pairs may err by the accuracy of a pair, A sqrt(G A_i)
      const double tolerance = 2e-6 * std::sqrt(none.exchange_areas(i, j) / 9);
      EXPECT_LE(one.exchange_areas(i, j), none.exchange_areas(i, j));
      EXPECT_LE(two.exchange_areas(i, j), one.exchange_areas(i, j) + tolerance);
      EXPECT_GE(two.exchange_areas(i, j), 0);
    }
  }
}

TEST(Visibility, DoesNotDependOnPlaceSizeOrDirection) {
  const PatchMesh mesh = testing::room_with_turned_boxes(4, 2);
  const FormFactors reference = factors(mesh, 1e-6);
  for (double scale : {1.0, 1e-3, 1e3}) {
    Eigen::Affine3d placement = Eigen::Affine3d::Identity();
    placement.translate(Vec3(10, -20, 5) * scale).rotate(turned(0.7, 0.4, -0.9)).scale(scale);
    const FormFactors f = factors(testing::room_with_turned_boxes(4, 2, placement), 1e-6);
    for (int i = 0; i < mesh.size(); ++i) {
      for (int j = 0; j < i; ++j) {
        const double smaller = std::min(mesh.areas[i], mesh.areas[j]);
        EXPECT_NEAR(f.exchange_areas(i, j) / (scale * scale), reference.exchange_areas(i, j), 5e-6 * smaller);
      }
    }
  }
}

TEST(Visibility, HasTheSameBitsForAnyNumberOfThreads) {
  const PatchMesh boxes = testing::room_with_turned_boxes(6, 3), leaves = room_with_leaves();
  for (const auto& [scene, way] :
       {std::pair(&boxes, Visibility::automatic), std::pair(&boxes, Visibility::rays),
        std::pair(&leaves, Visibility::automatic)}) {
    const PatchMesh& mesh = *scene;
    FormFactors one, two;
    {
      const tbb::global_control single(tbb::global_control::max_allowed_parallelism, 1);
      one = factors(mesh, 1e-3, way);
    }
    two = factors(mesh, 1e-3, way);
    for (int i = 0; i < mesh.size(); ++i) {
      for (int j = 0; j < i; ++j) ASSERT_EQ(one.exchange_areas(i, j), two.exchange_areas(i, j));
    }
    EXPECT_EQ(one.report.rays, two.report.rays);
    EXPECT_EQ(one.report.estimated_error, two.report.estimated_error);
  }
}

TEST(Visibility, CountsWhatItDid) {
  const PatchMesh mesh = testing::room_with_box(6, 3);

  const FormFactorReport exact = factors(mesh, 1e-4, Visibility::exact).report;
  const FormFactorReport rays = factors(mesh, 1e-2, Visibility::rays).report;

  EXPECT_EQ(exact.occluders, 6);
  EXPECT_GT(exact.hidden_pairs, 0);
  EXPECT_EQ(exact.exact_pairs, exact.partial_pairs);
  EXPECT_EQ(exact.rays, 0);
  EXPECT_EQ(rays.sampled_pairs, rays.partial_pairs);
  EXPECT_GT(rays.rays, 0);
  EXPECT_LE(exact.hidden_pairs + exact.partial_pairs, exact.facing_pairs);
}

TEST(Visibility, StopsWhenToldTo) {
  const PatchMesh mesh = testing::room_with_box(6, 3);
  const Progress stop = [](std::string_view stage, double, double) { return stage != "visibility"; };

  EXPECT_THROW(form_factors(mesh, {}, stop), Cancelled);
}

}  // namespace
}  // namespace luxel
