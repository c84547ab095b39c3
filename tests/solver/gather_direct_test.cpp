#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>

#include "luxel/form_factors.h"
#include "luxel/gather_operator.h"
#include "solver/gather_scenes.h"
#include "transport/gather/lamps.h"

namespace luxel {
namespace {

using namespace luxel::testing;

constexpr double pi = std::numbers::pi;

/// Form factor from a point to a parallel rectangle a x b at distance c whose corner lies above it.
/// Source: Howell, A Catalog of Radiation Heat Transfer Configuration Factors, B-4.
double below_a_corner(double a, double b, double c) {
  const double x = a / c, y = b / c, p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
  return (x / p * std::atan(y / p) + y / q * std::atan(x / q)) / (2 * pi);
}

/// A small square at the origin facing up, a lamp 2 x 2 at height 1 above it facing down, and more.
PatchMesh square_below_a_lamp(int cuts, std::vector<std::array<Vec3, 4>> more = {}) {
  Boxes faces;
  const double s = 1e-3;
  const auto add = [&](const std::array<Vec3, 4>& corners) {
    const int first = static_cast<int>(faces.vertices.size());
    faces.vertices.insert(faces.vertices.end(), corners.begin(), corners.end());
    faces.faces.push_back({first, first + 1, first + 2, first + 3});
  };
  add({Vec3(-s, -s, 0), Vec3(s, -s, 0), Vec3(s, s, 0), Vec3(-s, s, 0)});
  add({Vec3(-1, -1, 1), Vec3(-1, 1, 1), Vec3(1, 1, 1), Vec3(1, -1, 1)});
  for (const auto& corners : more) add(corners);
  return cut_faces(faces, cuts);
}

double light_on_first(const PatchMesh& mesh, const PatchField& emission, const GatherOptions& options = {}) {
  return direct_irradiance(mesh, RayScene(mesh.occluders), emission, options).irradiance(0, 0);
}

TEST(DirectIrradiance, OfAnUnoccludedLampIsTheClosedForm) {
  const PatchMesh mesh = square_below_a_lamp(1);

  // the patch is small: its mean differs from its middle by about s^2 = 1e-6; offsets of float are 1e-6 too
  EXPECT_NEAR(light_on_first(mesh, glow(mesh, {1}, 3)), 3 * 4 * below_a_corner(1, 1, 1), 3e-5);
}

// A ceiling that reaches far behind an upright patch: only a thirtieth of it is in sight.
TEST(DirectIrradiance, OfALampThatLiesMostlyBehindIsTheClosedForm) {
  const double s = 0.01;
  const std::vector<Vec3> ceiling{Vec3(-29, -1, 1), Vec3(-29, 1, 1), Vec3(1, 1, 1), Vec3(1, -1, 1)};
  const std::vector<Vec3> triangle{Vec3(-29, -1, 1), Vec3(-29, 1, 1), Vec3(1, 1, 1)};
  for (const auto& lamp : {ceiling, triangle}) {
    std::vector<Vec3> vertices{Vec3(0, -s, -s), Vec3(0, s, -s), Vec3(0, s, s), Vec3(0, -s, s)};
    vertices.insert(vertices.end(), lamp.begin(), lamp.end());
    const PatchMesh mesh = hand_made_mesh(vertices, {{0, 1, 2, 3}, {4, 5, 6, lamp.size() == 4 ? 7 : -1}});

    // the mean over the patch differs from its middle by about s^2
    EXPECT_NEAR(light_on_first(mesh, glow(mesh, {1})), point_form_factor(Vec3::Zero(), Vec3::UnitX(), lamp),
                1e-4);
  }
}

// An upright square on a lamp that passes through its foot, or its middle, and reaches `depth` in front of
// it.
TEST(DirectIrradiance, OfALampThatTouchesOrPiercesThePatchIsTheClosedForm) {
  for (const double depth : {1.0, 0.1, 0.01}) {
    for (const double below : {0.0, 0.5}) {
      const PatchMesh mesh = hand_made_mesh(
          {Vec3(0, 0, -below), Vec3(0, 1, -below), Vec3(0, 1, 1 - below), Vec3(0, 0, 1 - below),
           Vec3(-2, 0, 0), Vec3(depth, 0, 0), Vec3(depth, 1, 0), Vec3(-2, 1, 0)},
          {{0, 1, 2, 3}, {4, 5, 6, 7}});
      const double above = 1 - below;

      // rules that differ by 2e-3 are a tenth of that off; lifting patches off surfaces takes 4e-7 / depth
      EXPECT_NEAR(light_on_first(mesh, glow(mesh, {1})) / (above * around_a_corner(above, depth)), 1, 5e-4)
          << depth << ' ' << below;
    }
  }
}

// Of a floor patch only a strip of a hundredth lies in front of the lamp that stands on it.
TEST(DirectIrradiance, OnAPatchMostlyBehindTheLampIsTheClosedForm) {
  const double strip = 0.01, height = 0.1;
  const PatchMesh mesh =
      hand_made_mesh({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0), Vec3(0, 1 - strip, 0),
                      Vec3(0, 1 - strip, height), Vec3(1, 1 - strip, height), Vec3(1, 1 - strip, 0)},
                     {{0, 1, 2, 3}, {4, 5, 6, 7}});

  EXPECT_NEAR(light_on_first(mesh, glow(mesh, {1})) / (strip * around_a_corner(strip, height)), 1, 5e-4);
}

TEST(DirectIrradiance, DoesNotDependOnHowTheLampIsCut) {
  const PatchMesh whole = square_below_a_lamp(1), cut = square_below_a_lamp(7);

  EXPECT_NEAR(light_on_first(cut, glow(cut, {1})), light_on_first(whole, glow(whole, {1})), 1e-5);
}

TEST(DirectIrradiance, IsHalvedByAScreenOverHalfTheLamp) {
  const PatchMesh mesh =
      square_below_a_lamp(1, {{Vec3(0, -2, 0.5), Vec3(2, -2, 0.5), Vec3(2, 2, 0.5), Vec3(0, 2, 0.5)}});
  GatherOptions options;
  options.shadow_rays = 4096;

  // rays to a lamp cut by a straight edge: their net leaves 4096^-0.67 = 0.4 % of the contrast
  EXPECT_NEAR(light_on_first(mesh, glow(mesh, {1}), options), 2 * below_a_corner(1, 1, 1), 4e-3);
}

// A floor patch that shares an edge with the lamp, cut by screens into cells that see their own part of the
// lamp only: what arrives comes from close by.
TEST(DirectIrradiance, OfALampThatTouchesIsRightInPartialShadow) {
  constexpr int cells = 8, seeds = 32, rays = 1024;
  const PatchMesh mesh = squares_cut_by_screens(cells);
  GatherOptions options;
  options.shadow_rays = rays;
  const double expected = around_a_corner(cells, cells);
  double square = 0;
  for (options.seed = 0; options.seed < seeds; ++options.seed) {
    square += std::pow(light_on_first(mesh, glow(mesh, {1}), options) / expected - 1, 2) / seeds;
  }

  // no worse than chance among the rays drawn by the cosine that would meet the lamp
  const double whole = around_a_corner(1, 1), seen = expected / whole;
  EXPECT_LT(std::sqrt(square), std::sqrt((1 - seen) / (seen * rays * whole)));
}

TEST(DirectIrradiance, IsNothingBehindAWall) {
  const PatchMesh mesh =
      square_below_a_lamp(1, {{Vec3(-9, -9, 0.5), Vec3(9, -9, 0.5), Vec3(9, 9, 0.5), Vec3(-9, 9, 0.5)}});

  EXPECT_EQ(light_on_first(mesh, glow(mesh, {1})), 0);
}

TEST(DirectIrradiance, AddsLampsOfOtherColours) {
  const PatchMesh mesh =
      square_below_a_lamp(1, {{Vec3(-1, -1, 0), Vec3(-1, 1, 0), Vec3(-1, 1, 1), Vec3(-1, -1, 1)}});
  PatchField emission(mesh.size(), 2);
  emission << 0, 0, 2, 5, 7, 3;

  const PatchField both = direct_irradiance(mesh, RayScene(mesh.occluders), emission).irradiance;

  const double above = light_on_first(mesh, glow(mesh, {1})), beside = light_on_first(mesh, glow(mesh, {2}));
  EXPECT_NEAR(both(0, 0), 2 * above + 7 * beside, 1e-12);
  EXPECT_NEAR(both(0, 1), 5 * above + 3 * beside, 1e-12);
}

TEST(DirectIrradiance, GivesTheSameBitsForAnyNumberOfThreads) {
  const PatchMesh mesh = cut_faces(room_with_a_box(), 6);
  const PatchField emission = glow(mesh, {1});
  const auto direct = [&] { return direct_irradiance(mesh, RayScene(mesh.occluders), emission).irradiance; };
  PatchField serial;
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    serial = direct();
  }

  EXPECT_EQ(direct(), serial);
}

Lamp rectangle(const std::array<Vec3, 4>& corners) {
  Lamp lamp;
  for (int k = 0; k < 4; ++k) lamp.outline.push_back({corners[k], corners[(k + 1) % 4]});
  lamp.normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  lamp.offset = lamp.normal.dot(corners[0]);
  return lamp;
}

TEST(FormFactor, CutsALampAtTheHorizon) {
  // a wall from far below the ground to height h, at distance c, endless to both sides: (1 - cos) / 2 with
  // tan = h / c, the two-dimensional closed form
  const double h = 2, c = 1.5, endless = 1e5;
  const Lamp wall =
      rectangle({Vec3(c, -endless, -3), Vec3(c, -endless, h), Vec3(c, endless, h), Vec3(c, endless, -3)});

  const double seen = form_factor(Vec3::Zero(), Vec3::UnitZ(), wall);

  EXPECT_NEAR(seen, (1 - std::cos(std::atan(h / c))) / 2, 1e-9);  // the ends are missing: (c / endless)^2
}

TEST(FormFactor, SeesNothingFromBehind) {
  const Lamp wall = rectangle({Vec3(1, -1, 0), Vec3(1, -1, 1), Vec3(1, 1, 1), Vec3(1, 1, 0)});

  EXPECT_EQ(form_factor(Vec3(2, 0, 0), Vec3::UnitZ(), wall), 0);
}

TEST(LampsOf, JoinsPatchesThatEmitAlikeOnOnePolygon) {
  const PatchMesh mesh = cut_faces(Boxes().add({0, 0, 0}, {1, 1, 1}, true), 4, true);
  PatchField emission = glow(mesh, {1, 2});
  emission.col(0) *= 2;
  emission(0, 0) = 1;  // and one patch of the floor

  const std::vector<Lamp> lamps = lamps_of(mesh, emission, RayScene(mesh.occluders));

  ASSERT_EQ(lamps.size(), 3u);
  EXPECT_TRUE(lamps[0].triangle);
  EXPECT_EQ(lamps[1].outline.size(), 4u);
  EXPECT_TRUE(lamps[1].fills_frame);
  EXPECT_NEAR(lamps[1].area, 1, 1e-12);
}

}  // namespace
}  // namespace luxel
