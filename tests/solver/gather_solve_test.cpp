#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "luxel/dense_operator.h"
#include "luxel/form_factors.h"
#include "luxel/gather_operator.h"
#include "solver/gather_scenes.h"

namespace luxel {
namespace {

using namespace luxel::testing;

GatheredSolution gathered(const PatchMesh& mesh, double reflectance, const PatchField& emission,
                          const GatherOptions& options, double tolerance = 1e-6) {
  SolveOptions solving;
  solving.tolerance = tolerance;
  return solve_gathered(mesh, RayScene(mesh.occluders),
                        PatchField::Constant(mesh.size(), emission.cols(), reflectance), emission, options,
                        solving);
}

RadiositySolution dense(const PatchMesh& mesh, double reflectance, const PatchField& emission) {
  FormFactorOptions accurate;
  accurate.accuracy = 1e-4;
  const RayScene occluders(mesh.occluders);
  const ClosedOperator closed =
      close_rows(form_factors(mesh, accurate).exchange_areas, mesh.areas, find_enclosures(mesh, occluders));
  return solve(*closed.transport, PatchField::Constant(mesh.size(), emission.cols(), reflectance), emission);
}

TEST(SolveGathered, IsExactInAFurnace) {
  const PatchMesh mesh = cut_faces(room_with_a_box(), 4);
  for (double reflectance : {0.5, 0.9}) {
    GatherOptions options;
    options.rays = 64;

    const GatheredSolution solution =
        gathered(mesh, reflectance, PatchField::Ones(mesh.size(), 1), options, 1e-12);

    EXPECT_FALSE(solution.report.plan.direct_apart);
    // B = E / (1 - rho); the final gather reads float32: 6e-8 relative
    const double expected = 1 / (1 - reflectance);
    EXPECT_LT((solution.light.radiosity.array() - expected).abs().maxCoeff(), 1e-7 * expected);
  }
}

TEST(SolveGathered, AgreesWithTheDenseOperatorWithinItsAccuracy) {
  const PatchMesh mesh = cut_faces(room_with_a_box(), 8);
  PatchField emission = PatchField::Zero(mesh.size(), 1);
  for (int i = 0; i < mesh.size(); ++i) {  // a square in the middle of the ceiling
    emission(i, 0) = mesh.faces[i] == 1 && (mesh.centroids[i] - Vec3(0.5, 0.5, 1)).norm() < 0.2;
  }
  const RadiositySolution exact = dense(mesh, 0.7, emission);

  for (double accuracy : {0.03, 0.01, 0.003}) {
    GatherOptions options;
    options.accuracy = accuracy;
    const GatheredSolution solution = gathered(mesh, 0.7, emission, options);

    EXPECT_TRUE(solution.report.plan.direct_apart);
    EXPECT_TRUE(solution.light.report.converged);
    EXPECT_LT(relative_rms(mesh, solution.light.irradiance, exact.irradiance), accuracy);
  }
}

TEST(SolveGathered, FoldsEmittersThatCoverMuchOfTheScene) {
  const PatchMesh mesh = cut_faces(room_with_a_box(), 8);
  const PatchField emission = glow(mesh, {0, 1, 2, 3});
  const RadiositySolution exact = dense(mesh, 0.7, emission);
  GatherOptions options;
  options.accuracy = 0.01;

  const GatheredSolution solution = gathered(mesh, 0.7, emission, options);

  EXPECT_FALSE(solution.report.plan.direct_apart);
  EXPECT_EQ(solution.direct.size(), 0);
  EXPECT_LT(relative_rms(mesh, solution.light.irradiance, exact.irradiance), options.accuracy);
}

TEST(SolveGathered, GivesTheSameBitsForAnyNumberOfThreads) {
  const PatchMesh mesh = cut_faces(room_with_a_box(), 6);
  const PatchField emission = glow(mesh, {1});
  const auto run = [&] { return gathered(mesh, 0.6, emission, {.rays = 96}).light.radiosity; };
  PatchField serial;
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    serial = run();
  }

  EXPECT_EQ(run(), serial);
}

TEST(SolveGathered, LeavesTheRoomNextDoorDark) {
  Boxes rooms = Boxes().add({0, 0, 0}, {1, 1, 1}, true).add({1, 0, 0}, {2, 1, 1}, true);
  for (auto& face : rooms.faces) {
    for (int& corner : face) {
      if (corner >= 8 && corner % 2 == 0) corner -= 7;
    }
  }
  const PatchMesh mesh = cut_faces(rooms, 6);

  const GatheredSolution solution = gathered(mesh, 0.8, glow(mesh, {1}), {.rays = 256});

  for (int i = 0; i < mesh.size(); ++i) {
    if (mesh.faces[i] >= 6) {
      EXPECT_EQ(solution.light.irradiance(i, 0), 0);
    } else if (mesh.faces[i] != 1) {
      EXPECT_GT(solution.light.irradiance(i, 0), 0);
    }
  }
}

TEST(SolveGathered, KeepsTheEnergyOfAClosedRoom) {
  const PatchMesh mesh = cut_faces(room_with_a_box(), 6);
  const PatchField emission = glow(mesh, {1});

  const GatheredSolution solution = gathered(mesh, 0.6, emission, {.rays = 1024});

  double emitted = 0, absorbed = 0;
  for (int i = 0; i < mesh.size(); ++i) {
    emitted += mesh.areas[i] * emission(i, 0);
    absorbed += mesh.areas[i] * 0.4 * solution.light.irradiance(i, 0);
  }
  // sums over 432 patches with 0.5 % error each, about independent: 0.03 %; shadows share theirs
  EXPECT_NEAR(absorbed / emitted, 1, 2e-3);
}

TEST(SolveGathered, LightsAnOpenCourtLessThanARoom) {
  Boxes court = Boxes().add({0, 0, 0}, {1, 1, 1}, true);
  court.faces.erase(court.faces.begin() + 1);
  const PatchMesh mesh = cut_faces(court, 8);
  const PatchField emission = glow(mesh, {0});
  const RadiositySolution exact = dense(mesh, 0.5, emission);
  GatherOptions options;
  options.accuracy = 0.01;

  const GatheredSolution solution = gathered(mesh, 0.5, emission, options);

  EXPECT_LT(relative_rms(mesh, solution.light.irradiance, exact.irradiance), options.accuracy);
}

TEST(SolveGathered, SmoothsNeighboursOnlyWhereThatHelps) {
  const PatchMesh mesh = cut_faces(room_with_a_box(), 12);
  const PatchField emission = glow(mesh, {1});
  GatherOptions options;
  options.rays = 1 << 14;
  options.seed = 5;
  options.fit = false;
  const PatchField fine = gathered(mesh, 0.7, emission, options).light.irradiance;
  options.rays = 64;
  options.seed = 0;

  const double plain = relative_rms(mesh, gathered(mesh, 0.7, emission, options).light.irradiance, fine);
  options.fit = true;
  const double fitted = relative_rms(mesh, gathered(mesh, 0.7, emission, options).light.irradiance, fine);

  EXPECT_LT(fitted, plain);
}

TEST(SolveGathered, KeepsADarkSceneDark) {
  const PatchMesh mesh = cut_faces(room_with_a_box(), 2);

  const GatheredSolution solution = gathered(mesh, 0.7, PatchField::Zero(mesh.size(), 3), {.rays = 16});

  EXPECT_EQ(solution.light.radiosity.cwiseAbs().maxCoeff(), 0);
}

}  // namespace
}  // namespace luxel
