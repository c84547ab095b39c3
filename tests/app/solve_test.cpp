// `luxel solve` against closed forms: the cases whose answer with one patch per face is known exactly.
#include <cmath>

#include <gtest/gtest.h>

#include "app/program.h"

namespace luxel::test {
namespace {

using nlohmann::json;

Solved solve_exactly(const std::string& scene) {
  return solve(scene, {"--as-is", "--accuracy", "1e-6", "--tolerance", "1e-12"});
}

// The norm for these cases: every B to 1e-5 relative, for form factors that are right to 1e-6.
void expect_radiosity(const Solved& solved, const std::vector<double>& exact, double tolerance = 1e-5) {
  ASSERT_EQ(solved.outcome.status, 0) << solved.outcome.err;
  for (const char* channel : {"B_r", "B_g", "B_b"}) {
    const auto radiosity = csv_column(solved.csv, channel);
    ASSERT_EQ(radiosity.size(), exact.size());
    for (std::size_t i = 0; i < exact.size(); ++i) {
      EXPECT_NEAR(radiosity[i], exact[i], tolerance * exact[i]) << channel << " of patch " << i;
    }
  }
  // light is neither made nor lost: the balance closes to rounding after a solve to 1e-12
  EXPECT_LE(solved.report["energy"]["imbalance"].get<double>(), 1e-10);
}

json finish(double reflectance, double exitance = 0) {
  return {{"reflectance", reflectance}, {"exitance", exitance}};
}

// Exact form factors of opposite and adjacent faces of a cube (Howell C-11, C-14), 6 x 6 system in 20 digits.
TEST(Solve, CubeOfSixPatchesHasItsExactRadiosity) {
  const json surfaces = {{"floor", finish(0.2)}, {"ceiling", finish(0.8, 1)}};

  const Solved solved = solve_exactly(scene_text("cube", {{"white", finish(0.5)}}, surfaces));

  expect_radiosity(solved, {0.0720558695573895, 1.12060284605824, 0.170406452563970, 0.170406452563970,
                            0.170406452563970, 0.170406452563970});
}

TEST(Solve, BrightCubeKeepsItsAccuracyOverAThousandBounces) {
  const json surfaces = {{"floor", finish(0.999, 1)}};

  const Solved solved = solve_exactly(scene_text("cube", {{"white", finish(0.999)}}, surfaces));

  expect_radiosity(solved, {167.361226893290, 166.527633111084, 166.527784998906, 166.527784998906,
                            166.527784998906, 166.527784998906});
}

// F = 1/3 between any two faces; rational arithmetic.
TEST(Solve, TetrahedronHasItsRationalRadiosity) {
  const json surfaces = {
      {"face0", finish(0.2, 1)}, {"face1", finish(0.5)}, {"face2", finish(0.8)}, {"face3", finish(0.3)}};

  const Solved solved = solve_exactly(scene_text("tetrahedron", {}, surfaces));

  expect_radiosity(solved, {2439.0 / 2309, 627.0 / 2309, 924.0 / 2309, 399.0 / 2309});
}

// Exact 12 x 12 form factors by contour integrals.
TEST(Solve, CubeOfTwelveTrianglesHasItsExactRadiosity) {
  const json materials = {{"floor", finish(0.2)}, {"ceiling", finish(0.8, 1)}, {"y0", finish(0.5)},
                          {"x1", finish(0.63)},   {"y1", finish(0.5)},         {"x0", finish(0.14)}};

  const Solved solved = solve_exactly(scene_text("cube12", materials));

  expect_radiosity(solved, {0.06669527107469, 0.06274247053803, 1.115134122973, 1.096056594666,
                            0.1864241766691, 0.1287590414060, 0.2369746293760, 0.1507381872642,
                            0.1957730885946, 0.1162040798793, 0.05624907756772, 0.03728827835606});
}

TEST(Solve, LongCorridorIsRightThroughFiveDecades) {
  json materials = {{"wall_x0", finish(0.5, 1)}};
  for (const char* wall : {"wall_x1", "wall_y0", "wall_y1", "wall_z0", "wall_z1"})
    materials[wall] = finish(0.5);

  const Solved solved = solve_exactly(scene_text("corridor10", materials));

  // x = 0, x = 10, then four walls of ten segments
  std::vector<double> exact = {1.066640121279, 0.002046244613923};
  for (int wall = 0; wall < 4; ++wall) {
    exact.insert(exact.end(), {0.1581818694050, 0.04589517530509, 0.01577555608957, 0.006296692196976,
                               0.002874086029255, 0.001479137977229, 0.0008477497907018, 0.0005433749722499,
                               0.0004202941633131, 0.0005144725972878});
  }
  expect_radiosity(solved, exact);
}

// B1 = 1 / (1 - rho^2 F^2), B2 = rho F B1.
TEST(Solve, TwoPlatesInTheOpenHaveTheirExactRadiosityAndLoss) {
  const json surfaces = {{"surf1", finish(0.5, 1)}, {"surf2", finish(0.5)}};

  const Solved solved = solve_exactly(scene_text("vf_c11_1x1_h1", {}, surfaces));

  expect_radiosity(solved, {1.01008315227492, 0.100919880275018});
  EXPECT_FALSE(solved.report["scene"]["closed"].get<bool>());
  EXPECT_NEAR(solved.report["energy"]["escaped"][0].get<double>(), 0.888996967450058, 1e-5);
}

TEST(Solve, ChannelsAreSolvedEachWithItsOwnReflectance) {
  const json walls = {{"reflectance", {0.5, 0.9, 0.0}}, {"exitance", {1, 2, 3}}};

  const Solved solved = solve_exactly(scene_text("cube", {{"white", walls}}));

  ASSERT_EQ(solved.outcome.status, 0) << solved.outcome.err;
  // E / (1 - rho); closure holds to 1e-12, which 1 / (1 - rho) = 10 makes 1e-11
  EXPECT_NEAR(csv_column(solved.csv, "B_r")[0], 2, 1e-10);
  EXPECT_NEAR(csv_column(solved.csv, "B_g")[0], 20, 1e-9);
  EXPECT_NEAR(csv_column(solved.csv, "B_b")[0], 3, 1e-10);
}

struct Furnace {
  std::string mesh;
  double reflectance;
};

class WhiteFurnace : public testing::TestWithParam<std::tuple<std::string, double>> {};

TEST_P(WhiteFurnace, HasTheSameLightOnEveryPatch) {
  const auto [mesh_name, rho] = GetParam();

  const Solved solved =
      solve(scene_text(mesh_name, {{"white", finish(rho, 1)}}), {"--as-is", "--tolerance", "1e-12"});

  ASSERT_EQ(solved.outcome.status, 0) << solved.outcome.err;
  EXPECT_TRUE(solved.report["scene"]["closed"].get<bool>());
  // rows closed to 1e-12 and a residual of 1e-12, times 1 / (1 - rho) <= 1000
  const double exact = 1 / (1 - rho);
  for (const double b : csv_column(solved.csv, "B_g")) EXPECT_NEAR(b, exact, 1e-8 * exact);
  EXPECT_LE(solved.report["energy"]["imbalance"].get<double>(), 1e-10);
}

INSTANTIATE_TEST_SUITE_P(AnyClosedMesh, WhiteFurnace,
                         testing::Combine(testing::Values("cube", "tetrahedron", "room_with_block",
                                                          "lroom_pinney_bean"),
                                          testing::Values(0.5, 0.9, 0.999)));

TEST(Solve, BouncesHoldTheLightOfSoManyBounces) {
  const Solved solved = solve(scene_text("cube", {{"white", finish(0.9, 1)}}), {"--as-is", "--bounces", "7"});

  ASSERT_EQ(solved.outcome.status, 0) << solved.outcome.err;
  EXPECT_EQ(solved.report["solver"]["method"], "neumann");
  EXPECT_EQ(solved.report["solver"]["iterations"], 7);
  // geometric series; seven applications of rows that are closed to 1e-12
  const double exact = (1 - std::pow(0.9, 8)) / (1 - 0.9);
  for (const double b : csv_column(solved.csv, "B_r")) EXPECT_NEAR(b, exact, 1e-10 * exact);
}

class EverySolver : public testing::TestWithParam<std::string> {};

TEST_P(EverySolver, FindsTheSameLight) {
  const json surfaces = {{"floor", finish(0.2)}, {"ceiling", finish(0.8, 1)}};

  const Solved solved =
      solve(scene_text("cube", {{"white", finish(0.5)}}, surfaces),
            {"--as-is", "--accuracy", "1e-6", "--tolerance", "1e-12", "--solver", GetParam()});

  expect_radiosity(solved, {0.0720558695573895, 1.12060284605824, 0.170406452563970, 0.170406452563970,
                            0.170406452563970, 0.170406452563970});
  EXPECT_LE(solved.report["solver"]["relative_residual"].get<double>(), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(ByName, EverySolver,
                         testing::Values("auto", "cholesky", "lu", "cg", "gmres", "neumann", "jacobi",
                                         "gauss-seidel", "southwell"));

}  // namespace
}  // namespace luxel::test
