#include "luxel/group_factors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "luxel/dense_operator.h"
#include "solver/hand_made_mesh.h"

namespace luxel {
namespace {

using testing::Boxes;
using testing::hand_made_mesh;

// Four patches: exchange areas chosen by hand.
DenseOperator four_patches() {
  ExchangeMatrix exchange(4, Precision::float64);
  exchange.set(1, 0, 0.125);
  exchange.set(2, 0, 0.25);
  exchange.set(3, 0, 0.5);
  exchange.set(2, 1, 0.0625);
  exchange.set(3, 1, 0.25);
  exchange.set(3, 2, 0.125);
  return DenseOperator(std::move(exchange), {1, 2, 4, 1});
}

TEST(GroupFormFactors, AddUpExchangeAreas) {
  const DenseOperator transport = four_patches();
  const std::vector<int> groups{0, 0, 1, 1};

  const GroupFactors factors = group_form_factors(transport, groups, 2);

  EXPECT_EQ(factors.areas, (std::vector<double>{3, 5}));
  // powers of two: exact but for the divisions
  EXPECT_NEAR(factors.form_factors(0, 0), 2 * 0.125 / 3, 1e-15);
  EXPECT_NEAR(factors.form_factors(0, 1), (0.25 + 0.5 + 0.0625 + 0.25) / 3, 1e-15);
  EXPECT_NEAR(factors.form_factors(1, 0), (0.25 + 0.5 + 0.0625 + 0.25) / 5, 1e-15);
  EXPECT_NEAR(factors.form_factors(1, 1), 2 * 0.125 / 5, 1e-15);
}

TEST(GroupFormFactors, OfOnePatchEachAreTheFactorsThemselves) {
  const DenseOperator transport = four_patches();

  const GroupFactors factors = group_form_factors(transport, std::vector<int>{0, 1, 2, 3}, 4);

  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      EXPECT_NEAR(factors.form_factors(i, j), (*transport.entries())(i, j) / transport.areas()[i], 1e-16);
    }
  }
}

TEST(GroupFormFactors, OfAGroupWithoutPatchesAreZero) {
  const GroupFactors factors = group_form_factors(four_patches(), std::vector<int>{0, 0, 2, 2}, 3);

  EXPECT_EQ(factors.areas[1], 0);
  EXPECT_EQ(factors.form_factors.row(1).cwiseAbs().maxCoeff(), 0);
}

TEST(GroupFormFactors, RefuseGroupsOutOfRange) {
  EXPECT_THROW(group_form_factors(four_patches(), std::vector<int>{0, 1, 2, 3}, 3), std::invalid_argument);
  EXPECT_THROW(group_form_factors(four_patches(), std::vector<int>{0, 1}, 2), std::invalid_argument);
}

PatchMesh one_group_a_patch(PatchMesh mesh) {
  mesh.group_names.clear();
  for (int i = 0; i < mesh.size(); ++i) {
    mesh.groups[i] = i;
    mesh.group_names.push_back(std::to_string(i));
  }
  return mesh;
}

/// From a point below the corner of a rectangle a x b at height c, facing up (Howell's catalogue, B-4
/// family).
double under_corner(double a, double b, double c) {
  const double x = a / c, y = b / c;
  const double p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
  return (x / p * std::atan(y / p) + y / q * std::atan(x / q)) / (2 * std::numbers::pi);
}

TEST(PointToGroups, SeesTheLidOfABox) {
  const PatchMesh mesh = one_group_a_patch(Boxes().add({0, 0, 0}, {1, 1, 1}, true).mesh());

  const PointFactors factors = point_to_groups(mesh, {0.5, 0.5, 0}, Vec3::UnitZ());

  EXPECT_NEAR(factors.form_factors[1], 4 * under_corner(0.5, 0.5, 1), 1e-12);
  EXPECT_NEAR(factors.open, 0, 1e-12);
  EXPECT_EQ(factors.rays, 0);
  EXPECT_EQ(factors.error, 0);
}

TEST(PointToGroups, LosesExactlyWhatABlockerHides) {
  // a blocker at half height hides the quarter of the lid that it projects to
  Boxes box = Boxes().add({0, 0, 0}, {1, 1, 1}, true);
  for (const Vec3& x :
       {Vec3(0.5, 0.5, 0.5), Vec3(0.75, 0.5, 0.5), Vec3(0.75, 0.75, 0.5), Vec3(0.5, 0.75, 0.5)}) {
    box.vertices.push_back(x);
  }
  box.faces.push_back({8, 11, 10, 9});  // front down
  const PatchMesh mesh = one_group_a_patch(box.mesh());

  const PointFactors factors = point_to_groups(mesh, {0.5, 0.5, 0}, Vec3::UnitZ());

  EXPECT_NEAR(factors.form_factors[1], 3 * under_corner(0.5, 0.5, 1), 1e-12);
  EXPECT_NEAR(factors.form_factors[6], under_corner(0.25, 0.25, 0.5), 1e-12);
  EXPECT_NEAR(factors.open, 0, 1e-12);
}

TEST(PointToGroups, ATriangleHidesAsATriangle) {
  Boxes box = Boxes().add({0, 0, 0}, {1, 1, 1}, true);
  const auto with_blocker = [&](std::vector<std::array<int, 4>> blockers) {
    Boxes result = box;
    for (const Vec3& x :
         {Vec3(0.5, 0.5, 0.5), Vec3(0.75, 0.5, 0.5), Vec3(0.75, 0.75, 0.5), Vec3(0.5, 0.75, 0.5)}) {
      result.vertices.push_back(x);
    }
    for (const auto& blocker : blockers) result.faces.push_back(blocker);
    return one_group_a_patch(result.mesh());
  };
  const Vec3 point(0.5, 0.5, 0);

  const PointFactors one = point_to_groups(with_blocker({{8, 10, 9, -1}}), point, Vec3::UnitZ());

  // the diagonal passes above the point: by symmetry half of what the square hides
  EXPECT_NEAR(one.form_factors[1], 3.5 * under_corner(0.5, 0.5, 1), 1e-12);
}

TEST(PointToGroups, CountsBacksAndTheSkyAsOpen) {
  // a plate that shows its back to the point below, and nothing else
  const PatchMesh mesh =
      one_group_a_patch(hand_made_mesh({{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}, {{0, 1, 2, 3}}));

  const PointFactors factors = point_to_groups(mesh, {0.5, 0.5, 0}, Vec3::UnitZ());

  EXPECT_EQ(factors.form_factors[0], 0);
  EXPECT_EQ(factors.open, 1);
}

TEST(PointToGroups, RefusesANormalThatIsNotAUnitVector) {
  const PatchMesh mesh = Boxes().add({0, 0, 0}, {1, 1, 1}, true).mesh();

  EXPECT_THROW(point_to_groups(mesh, {0.5, 0.5, 0}, {0, 0, 2}), std::invalid_argument);
  EXPECT_THROW(point_to_groups(mesh, {0.5, 0.5, 0}, {0, 0, 0}), std::invalid_argument);
  EXPECT_THROW(point_to_groups(mesh, {0.5, 0.5, std::nan("")}, {0, 0, 1}), std::invalid_argument);
}

}  // namespace
}  // namespace luxel
