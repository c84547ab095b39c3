#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "luxel/input_error.h"
#include "solver/hierarchical_scenes.h"

namespace luxel {
namespace {

using namespace luxel::testing;

std::unique_ptr<HierarchicalOperator> of(const PatchMesh& mesh, double accuracy, std::uint64_t seed = 0) {
  return hierarchical_operator(mesh, enclosures_of(mesh), {accuracy, seed});
}

PatchField random_field(int rows, int columns, unsigned seed) {
  std::mt19937 random(seed);
  PatchField field(rows, columns);
  for (Eigen::Index k = 0; k < field.size(); ++k) field.data()[k] = random() / 4294967296.0;
  return field;
}

PatchField applied(const TransportOperator& transport, const PatchField& x) {
  PatchField y(x.rows(), x.cols());
  transport.apply(x.data(), y.data(), static_cast<int>(x.cols()));
  return y;
}

double weighted(std::span<const double> areas, const PatchField& x, const PatchField& y) {
  double sum = 0;
  for (Eigen::Index i = 0; i < x.rows(); ++i) sum += areas[i] * x(i, 0) * y(i, 0);
  return sum;
}

TEST(HierarchicalOperator, IsReciprocal) {
  const PatchMesh mesh = room_with_turned_boxes(12, 6);
  const auto transport = of(mesh, 0.03);
  const PatchField x = random_field(mesh.size(), 1, 1), y = random_field(mesh.size(), 1, 2);

  const double there = weighted(transport->areas(), x, applied(*transport, y));
  const double back = weighted(transport->areas(), y, applied(*transport, x));

  EXPECT_TRUE(transport->symmetric());
  EXPECT_NEAR(there, back, 1e-12 * there);  // the order of a few thousand float64 additions
}

TEST(HierarchicalOperator, IsReciprocalOnItsNodes) {
  const PatchMesh mesh = room_with_turned_boxes(12, 6);
  const auto transport = of(mesh, 0.03);
  const TransportOperator& coarse = transport->coarse();
  const PatchField x = random_field(coarse.size(), 1, 1), y = random_field(coarse.size(), 1, 2);

  const double there = weighted(coarse.areas(), x, applied(coarse, y));
  const double back = weighted(coarse.areas(), y, applied(coarse, x));

  EXPECT_NEAR(there, back, 1e-12 * there);
}

TEST(HierarchicalOperator, HasRowsThatSumToOneInClosedScenes) {
  for (const PatchMesh& mesh : {room_with_turned_boxes(10, 5), inward_sphere(12),
                                cut_faces(Boxes().add({0, 0, 0}, {1, 1, 1}, true), 9, true)}) {
    const auto transport = of(mesh, 0.03);

    for (double sum : transport->row_sums()) EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_TRUE(transport->report().closure.applied);
    EXPECT_EQ(transport->report().closure.unclosed, -1);
    // what scaling repaired: a block may err by the accuracy in a row, ten times at worst
    EXPECT_LT(transport->report().closure.before.rms, 0.03);
    EXPECT_LT(transport->report().closure.before.max, 0.3);
  }
}

TEST(HierarchicalOperator, KeepsRowsNextToShadowedGapsWithinAFewTimesItsAccuracy) {
  // a leaning slab a twenty-fifth above the floor and off a wall
  SceneBuilder scene;
  const Eigen::Matrix3d lean = Eigen::AngleAxisd(0.3, Vec3::UnitY()).toRotationMatrix();
  scene.box({0, 0, 0}, {1, 1, 1}, Eigen::Matrix3d::Identity(), 48, true);
  scene.box({0.2, 0.04, 0.1}, {0.45, 0.64, 0.6}, lean, 24, false);
  const PatchMesh mesh = scene.take();
  Enclosures enclosures;
  enclosures.count = 1;
  enclosures.enclosure.assign(mesh.size(), 0);
  enclosures.enclosure_closed = {1};
  for (auto* shares : {&enclosures.open_share, &enclosures.back_share, &enclosures.share_error}) {
    shares->assign(mesh.size(), 0);
  }
  const PatchField reflectance = PatchField::Constant(mesh.size(), 1, 0.6);
  PatchField emission = PatchField::Zero(mesh.size(), 1);
  for (int i = 0; i < mesh.size(); ++i) emission(i, 0) = mesh.centroids[i].z() > 0.99;

  for (double accuracy : {0.03, 0.01}) {
    const auto transport = hierarchical_operator(mesh, enclosures, reflectance, emission, {accuracy});
    EXPECT_LT(transport->report().closure.before.max, 3 * accuracy);
    EXPECT_LT(transport->report().closure.before.rms, 0.45 * accuracy);
  }
}

TEST(HierarchicalOperator, LeavesRowsOfOpenScenesToTheSky) {
  // a cube without its lid: every row lacks what the lid would get
  Boxes boxes = Boxes().add({0, 0, 0}, {1, 1, 1}, true);
  std::erase_if(boxes.faces, [&](const auto& face) {
    return std::all_of(face.begin(), face.end(), [&](int v) { return boxes.vertices[v].z() == 1; });
  });
  const PatchMesh open = cut_faces(boxes, 12);
  const std::vector<Vec3> lid{{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}};
  constexpr double accuracy = 0.01;

  const auto transport = of(open, accuracy);

  EXPECT_FALSE(transport->report().closure.applied);
  EXPECT_EQ(transport->report().rays, 0);  // the cube is convex
  double squares = 0, total = 0;
  for (int i = 0; i < open.size(); ++i) {
    std::vector<Vec3> patch;
    for (int k = 0; k < 4; ++k) patch.push_back(open.vertices[open.corners[i][k]]);
    const double sky = exchange_area(patch, lid) / open.areas[i];
    const double off = transport->row_sums()[i] - (1 - sky);
    squares += open.areas[i] * off * off;
    total += open.areas[i];
    EXPECT_LT(std::abs(off), 10 * accuracy);
  }
  EXPECT_LT(std::sqrt(squares / total), accuracy);
}

TEST(HierarchicalOperator, GivesTheFormFactorsOfOppositeAndAdjacentFacesOfACube) {
  const PatchMesh mesh = cut_faces(Boxes().add({0, 0, 0}, {1, 1, 1}, true), 16);
  const auto transport = of(mesh, 0.01);
  PatchField floor = PatchField::Zero(mesh.size(), 1);
  for (int i = 0; i < mesh.size(); ++i) floor(i, 0) = mesh.normals[i].z() > 0.5;

  const PatchField irradiance = applied(*transport, floor);

  double opposite = 0, adjacent = 0;
  for (int i = 0; i < mesh.size(); ++i) {
    if (mesh.normals[i].z() < -0.5) opposite += mesh.areas[i] * irradiance(i, 0);
    if (std::abs(mesh.normals[i].x()) > 0.5) adjacent += mesh.areas[i] * irradiance(i, 0) / 2;
  }
  // Hottel: 0.199825 between opposite faces; the rest goes to four others. Means over faces err less than
  // rows.
  EXPECT_NEAR(opposite, 0.199825, 0.01 * 0.2);
  EXPECT_NEAR(adjacent, (1 - 0.199825) / 4, 0.01 * 0.2);
}

TEST(HierarchicalOperator, AgreesWithTheDenseOperator) {
  const PatchMesh mesh = room_with_turned_boxes(10, 5);
  const ClosedOperator dense = dense_of(mesh);
  PatchField x = PatchField::Ones(mesh.size(), 2);
  for (int i = 0; i < mesh.size(); ++i)
    x(i, 1) = 1 + std::sin(5 * mesh.centroids[i].x()) * mesh.centroids[i].y();
  const PatchField expected = applied(*dense.transport, x);

  for (double accuracy : {0.05, 0.01, 0.004}) {
    const PatchField found = applied(*of(mesh, accuracy), x);
    EXPECT_LT(relative_rms(mesh, found, expected), accuracy);
  }
}

TEST(HierarchicalOperator, AgreesWithTheDenseOperatorOnCurvedMeshes) {
  const PatchMesh mesh = inward_sphere(18);
  PatchField x(mesh.size(), 1);
  for (int i = 0; i < mesh.size(); ++i) x(i, 0) = 1 + 0.8 * mesh.centroids[i].z();
  const PatchField expected = applied(*dense_of(mesh, 1e-3).transport, x);

  for (double accuracy : {0.05, 0.01}) {
    EXPECT_LT(relative_rms(mesh, applied(*of(mesh, accuracy), x), expected), accuracy);
  }
}

TEST(HierarchicalOperator, SeesNothingThroughAWall) {
  // two closed rooms side by side
  SceneBuilder scene;
  scene.box({0, 0, 0}, {1, 1, 1}, Eigen::Matrix3d::Identity(), 8, true);
  scene.box({1.001, 0, 0}, {2, 1, 1}, Eigen::Matrix3d::Identity(), 8, true);
  const PatchMesh mesh = scene.take();
  PatchField x(mesh.size(), 1);
  for (int i = 0; i < mesh.size(); ++i) x(i, 0) = mesh.centroids[i].x() < 1.0005;

  const PatchField found = applied(*of(mesh, 0.01), x);

  for (int i = 0; i < mesh.size(); ++i) EXPECT_NEAR(found(i, 0), x(i, 0), 1e-12);
}

TEST(HierarchicalOperator, DoesNotDependOnScaleAndPlace) {
  const PatchMesh mesh = room_with_turned_boxes(8, 4);
  const PatchMesh moved_mesh = room_with_turned_boxes(
      8, 4, Eigen::Translation3d(1e4, -2e4, 3e4) * Eigen::Affine3d(Eigen::UniformScaling<double>(1000)));
  const PatchField x = random_field(mesh.size(), 1, 3);

  const PatchField here = applied(*of(mesh, 0.01), x), there = applied(*of(moved_mesh, 0.01), x);

  // equal clusters may be divided in another order, which draws other rays: each errs by the accuracy at most
  EXPECT_LT(relative_rms(mesh, there, here), 2 * 0.01);
}

TEST(HierarchicalOperator, HasTheSameBitsForAnyNumberOfThreads) {
  const LitRoom room = lit_room(12, 6);
  const Enclosures enclosures = enclosures_of(room.mesh);
  const auto run = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return solve_hierarchical(room.mesh, enclosures, room.reflectance, room.emission, {0.02}).light.radiosity;
  };

  EXPECT_EQ(run(1), run(2));
}

TEST(HierarchicalOperator, TakesAnotherSampleWithAnotherSeed) {
  const PatchMesh mesh = room_with_turned_boxes(10, 5);
  const PatchField x = random_field(mesh.size(), 1, 4);

  const PatchField one = applied(*of(mesh, 0.02, 1), x), other = applied(*of(mesh, 0.02, 2), x);

  EXPECT_NE(one, other);
  EXPECT_LT(relative_rms(mesh, one, other), 0.02);
}

TEST(HierarchicalOperator, CanBeCancelled) {
  const PatchMesh mesh = room_with_turned_boxes(10, 5);

  EXPECT_THROW(hierarchical_operator(mesh, enclosures_of(mesh), {0.01},
                                     [](std::string_view, double, double) { return false; }),
               Cancelled);
}

TEST(HierarchicalOperator, RefusesWhatDoesNotFit) {
  const PatchMesh mesh = cut_faces(room_with_a_box(), 2);
  const PatchMesh other = cut_faces(room_with_a_box(), 1);

  EXPECT_THROW(of(mesh, 0), std::invalid_argument);
  EXPECT_THROW(of(mesh, 0.5), std::invalid_argument);
  EXPECT_THROW(hierarchical_operator(mesh, enclosures_of(other)), std::invalid_argument);
  EXPECT_THROW(
      hierarchical_operator(mesh, enclosures_of(mesh), PatchField::Zero(3, 1), PatchField::Zero(3, 1)),
      std::invalid_argument);
}

TEST(HierarchicalOperator, HoldsOnePatchAndSeesNothing) {
  const PatchMesh mesh = hand_made_mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2, 3}});
  const auto transport = of(mesh, 0.01);

  ASSERT_EQ(transport->size(), 1);
  EXPECT_EQ(transport->row_sums()[0], 0);
}

// What is left of a pair that touches comes from close by, where the kernel is largest.
TEST(HierarchicalOperator, KnowsHowMuchOfATouchingPairIsHidden) {
  constexpr int cells = 8;
  const PatchMesh mesh = squares_cut_by_screens(cells);
  PatchField upright = PatchField::Zero(mesh.size(), 1);
  upright(1, 0) = 1;

  const double arrives = applied(*of(mesh, 0.003), upright)(0, 0);

  // up to 1024 rays drawn by the cosine, a fifteenth of which arrives: 12 %
  EXPECT_NEAR(arrives / around_a_corner(cells, cells), 1, 0.12);
}

}  // namespace
}  // namespace luxel
