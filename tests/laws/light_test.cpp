// Laws that the light of any scene obeys, held against the whole road from a scene to its light.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "laws/rooms.h"
#include "luxel/group_factors.h"

namespace luxel {
namespace {

using testing::finish;
using testing::furnished_room;
using testing::group_means;
using testing::lit;
using testing::Lit;
using testing::RoadOptions;
using testing::Room;
using testing::to_residual;

// Rounding of sums over some hundred patches at a residual of 1e-12.
constexpr double rounding = 1e-11;

TEST(Light, IsEverywhereTheSameInAWhiteFurnace) {
  for (const double rho : {0.5, 0.9, 0.999}) {
    Room room;
    room.box({0, 0, 0}, {4, 3, 2.5}, true, finish(rho, 1));
    room.box({1, 1, 0.5}, {2, 2.2, 1.7}, false, finish(rho, 1));

    const Lit furnace = lit(room.scene());

    ASSERT_TRUE(furnace.enclosures.closed);
    for (int i = 0; i < furnace.mesh.size(); ++i) {
      EXPECT_NEAR(furnace.light.radiosity(i, 0) * (1 - rho), 1, 1e-8) << "rho " << rho << ", patch " << i;
    }
  }
}

// A room of 2 x 2 x 1 whose floor and ceiling are two sheets each, with a strip of 0.4 x 2 in common.
TEST(Light, CountsOnceWhereFacesOverlap) {
  using Sides = Room::Sides;
  for (const double rho : {0.5, 0.9}) {
    const Finish white = finish(rho, 1);
    Room room;
    room.box({0, 0, 0}, {2, 2, 1}, true, Sides{std::nullopt, std::nullopt, white, white, white, white});
    for (const auto& [low, high] : {std::pair(0.0, 1.2), std::pair(0.8, 2.0)}) {
      room.box({low, 0, 0}, {high, 2, 1}, true,
               Sides{white, white, std::nullopt, std::nullopt, std::nullopt, std::nullopt});
    }

    const Lit furnace = lit(room.scene());

    ASSERT_TRUE(furnace.enclosures.closed);
    EXPECT_NEAR(total_area(furnace.mesh), 16, 1e-12);
    const std::vector<double> rows = row_sums(form_factors(furnace.mesh).exchange_areas, furnace.mesh.areas);
    for (int i = 0; i < furnace.mesh.size(); ++i) {
      EXPECT_NEAR(rows[i], 1, 2e-3) << i;  // before any closure, at the default accuracy: largest <= 2e-3
      EXPECT_NEAR(furnace.light.radiosity(i, 0) * (1 - rho), 1, 1e-8) << "rho " << rho << ", patch " << i;
    }
  }
}

TEST(Light, IsAbsorbedOrEscapes) {
  for (const bool window : {false, true}) {
    const Lit room = lit(furnished_room(window).scene());

    EXPECT_GT(room.energy.absorbed[0], 0);
    EXPECT_LE(room.energy.imbalance, rounding);
    if (window) {
      EXPECT_GT(room.energy.escaped[0], 0.05 * room.energy.emitted[0]);
    } else {
      EXPECT_NEAR(room.energy.escaped[0] / room.energy.emitted[0], 0, rounding);
    }
  }
}

// Helmholtz: a lamp on i lights j as a lamp on j of the same power lights i.
TEST(Light, IsTheSameWhenLampAndReceiverChangePlaces) {
  const Lit room = lit(furnished_room(true).scene());
  const int n = room.mesh.size();
  PatchField lamps = PatchField::Zero(n, 2);
  const int i = n / 7, j = n - n / 5;
  lamps(i, 0) = 1 / room.mesh.areas[i];
  lamps(j, 1) = 1 / room.mesh.areas[j];
  PatchField reflectance(n, 2);
  reflectance << room.reflectance.col(0), room.reflectance.col(0);

  const RadiositySolution light = solve(*room.transport, reflectance, lamps, to_residual(1e-13));

  EXPECT_GT(light.irradiance(j, 0), 0);
  EXPECT_NEAR(light.irradiance(j, 0) / light.irradiance(i, 1), 1, 1e-10);
}

TEST(Light, OfTwoLampsIsTheSumOfTheirLights) {
  const Lit room = lit(furnished_room().scene());
  const int n = room.mesh.size();
  PatchField lamps = PatchField::Zero(n, 3), reflectance(n, 3);
  lamps.block(0, 0, n / 3, 1).setConstant(2);
  lamps.block(n / 2, 1, n - n / 2, 1).setConstant(5);
  lamps.col(2) = lamps.col(0) + lamps.col(1);
  for (int c = 0; c < 3; ++c) reflectance.col(c) = room.reflectance.col(0);

  const PatchField radiosity = solve(*room.transport, reflectance, lamps, to_residual(1e-13)).radiosity;

  const PatchField difference = radiosity.col(2) - radiosity.col(0) - radiosity.col(1);
  EXPECT_LE(difference.cwiseAbs().maxCoeff(), rounding * radiosity.maxCoeff());
}

// 0 <= E <= B <= max E / (1 - max rho): no row of F is longer than 1.
TEST(Light, StaysWithinItsBounds) {
  for (const bool window : {false, true}) {
    const Lit room = lit(furnished_room(window).scene());

    EXPECT_GE((room.light.radiosity - room.emission).minCoeff(), 0);
    EXPECT_LE(room.light.radiosity.maxCoeff(), 10 / (1 - 0.8));
  }
}

TEST(Light, GrowsEverywhereWithAReflectance) {
  const Lit room = lit(furnished_room().scene());
  PatchField brighter = room.reflectance;
  const int wall = 2;
  for (int i = 0; i < room.mesh.size(); ++i) {
    if (room.mesh.groups[i] == wall) brighter.row(i).setConstant(0.6);
  }

  const PatchField radiosity = solve(*room.transport, brighter, room.emission, to_residual(1e-12)).radiosity;

  EXPECT_GT((radiosity - room.light.radiosity).minCoeff(), 0);
}

TEST(Light, DependsNeitherOnTheUnitNorOnThePlaceNorOnTheDirection) {
  const Scene scene = furnished_room(true).scene();
  const std::vector<double> means = group_means(lit(scene).mesh, lit(scene).light.radiosity);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.83, Vec3(0.2, -0.7, 0.5).normalized()).toRotationMatrix();
  struct Placement {
    double scale;
    Vec3 offset;
    Eigen::Matrix3d turn;
  };
  const Placement placements[] = {{1e-6, Vec3::Zero(), Eigen::Matrix3d::Identity()},
                                  {1e6, Vec3::Zero(), Eigen::Matrix3d::Identity()},
                                  {1, Vec3(1e6, -1e6, 1e6), Eigen::Matrix3d::Identity()},
                                  {3, Vec3(-7, 11, 0.3), turn}};

  for (const Placement& placement : placements) {
    Scene moved = scene;
    for (Vec3& x : moved.vertices) x = placement.scale * (placement.turn * x) + placement.offset;
    const Lit there = lit(moved);
    const std::vector<double> means_there = group_means(there.mesh, there.light.radiosity);

    // the mesher may choose other patches where rounding differs, so the accuracy of the mesh (n^-0.85)
    // holds, not that of the form factors
    for (std::size_t g = 0; g < means.size(); ++g) {
      EXPECT_NEAR(means_there[g] / means[g], 1, 5e-3) << "group " << g << ", scale " << placement.scale;
    }
  }
}

TEST(Light, DoesNotDependOnTheOrderOfTheFaces) {
  const Scene scene = furnished_room().scene();
  Scene reversed = scene;
  reversed.face_vertices.clear();
  reversed.face_offsets = {0};
  for (int f = scene.face_count() - 1; f >= 0; --f) {
    for (int k = scene.face_offsets[f]; k < scene.face_offsets[f + 1]; ++k) {
      reversed.face_vertices.push_back(scene.face_vertices[k]);
    }
    reversed.face_offsets.push_back(static_cast<int>(reversed.face_vertices.size()));
  }
  std::reverse(reversed.face_groups.begin(), reversed.face_groups.end());
  std::reverse(reversed.face_finishes.begin(), reversed.face_finishes.end());
  RoadOptions as_is;
  as_is.meshing = {.as_is = true};
  as_is.accuracy = 1e-6;

  const Lit one = lit(scene, as_is), other = lit(reversed, as_is);

  const int n = one.mesh.size();
  ASSERT_EQ(other.mesh.size(), n);
  for (int i = 0; i < n; ++i) {
    // the outer patch of a partly hidden pair may be the other one then
    EXPECT_NEAR(other.light.radiosity(n - 1 - i, 0) / one.light.radiosity(i, 0), 1, 1e-5) << i;
  }
}

TEST(Light, OnlyFallsWhereABlackBodyIsAdded) {
  Room empty;
  const Room::Sides walls = {finish(0.3), finish(0.1, 10), finish(0.5),
                             finish(0.7), finish(0.8),     finish(0.2)};
  empty.box({0, 0, 0}, {4, 3, 2.5}, true, walls);
  Room with_body = empty;
  with_body.box({1, 1, 0.5}, {2, 2.2, 1.7}, false, finish(0));

  const Lit before = lit(empty.scene()), after = lit(with_body.scene(), {.meshing = {.patches = 400}});

  const std::vector<double> bright = group_means(before.mesh, before.light.radiosity);
  const std::vector<double> dim = group_means(after.mesh, after.light.radiosity);
  for (int side = 0; side < 6; ++side) {
    if (side == 1) continue;  // the ceiling's own emission drowns the difference
    EXPECT_LT(dim[side], 0.99 * bright[side]) << "side " << side;
  }
}

// Form factors between whole sides do not depend on how the sides are cut.
TEST(FormFactorsBetweenSides, DoNotDependOnThePatches) {
  const Scene scene = furnished_room().scene();

  const Lit coarse = lit(scene, {.meshing = {.as_is = true}}),
            fine = lit(scene, {.meshing = {.patches = 500}});

  const GroupFactors a = group_form_factors(*coarse.transport, coarse.mesh.groups, 12);
  const GroupFactors b = group_form_factors(*fine.transport, fine.mesh.groups, 12);
  EXPECT_NEAR(a.areas[0], 12, 1e-12);
  EXPECT_LE((a.form_factors - b.form_factors).cwiseAbs().maxCoeff(), 2e-4);  // twice the accuracy
}

// What leaves one patch is seen by all others or gets out: closed rows, and symmetric exchange.
TEST(ExchangeOfARoom, IsClosedAndReciprocal) {
  const Lit room = lit(furnished_room().scene());
  const int n = room.mesh.size();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform;
  PatchField x(n, 2), y(n, 2);
  for (double& value : x.reshaped()) value = uniform(random);

  room.transport->apply(x.data(), y.data(), 2);

  const Eigen::Map<const Eigen::VectorXd> areas(room.mesh.areas.data(), n);
  const double there = (areas.array() * x.col(0).array() * y.col(1).array()).sum();
  const double back = (areas.array() * x.col(1).array() * y.col(0).array()).sum();
  EXPECT_NEAR(there / back, 1, 1e-13);
  for (const double sum : room.transport->row_sums()) EXPECT_NEAR(sum, 1, 1e-12);
}

}  // namespace
}  // namespace luxel
