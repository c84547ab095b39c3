#include "luxel/operator_error.h"

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

/// A room with a box, lit by a quarter of its ceiling, and its light with exact form factors.
struct LitRoom {
  PatchMesh mesh = cut_faces(room_with_a_box(), 5);
  PatchField rho = PatchField::Constant(mesh.size(), 1, 0.7);
  PatchField emission = PatchField::Zero(mesh.size(), 1);
  RayScene occluders{mesh.occluders};
  RadiositySolution exact;

  LitRoom() {
    for (int i = 0; i < mesh.size(); ++i) {
      emission(i, 0) = mesh.faces[i] == 1 && mesh.centroids[i][0] < 0.5 && mesh.centroids[i][1] < 0.5;
    }
    FormFactorOptions accurate;
    accurate.accuracy = 1e-5;
    const ClosedOperator closed =
        close_rows(form_factors(mesh, accurate).exchange_areas, mesh.areas, find_enclosures(mesh, occluders));
    SolveOptions solving;
    solving.tolerance = 1e-10;
    exact = solve(*closed.transport, rho, emission, solving);
  }

  OperatorError error_of(const RadiositySolution& light, double accuracy, std::uint64_t seed = 0,
                         double most_rays = 5e5) const {
    OperatorErrorOptions options;
    options.accuracy = accuracy;
    options.seed = seed;
    options.most_rays = most_rays;
    return operator_error(mesh, occluders, rho, emission, light, {}, options);
  }

  /// The light that belongs to an irradiance.
  RadiositySolution with_irradiance(const PatchField& irradiance) const {
    return {emission + rho.cwiseProduct(irradiance), irradiance, {}};
  }
};

TEST(OperatorError, IntervalHoldsTheTrueErrorOfGathers) {
  const LitRoom room;
  int held = 0, runs = 0;

  for (const double accuracy : {0.04, 0.015}) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      GatherOptions options;
      options.accuracy = accuracy;
      options.seed = seed;
      const RadiositySolution light =
          solve_gathered(room.mesh, room.occluders, room.rho, room.emission, options).light;
      const double truth = relative_rms(room.mesh, light.irradiance, room.exact.irradiance);
      const OperatorError error = room.error_of(light, accuracy, seed);
      held += error.low <= truth && truth <= error.high;
      ++runs;
      EXPECT_LE(error.low, error.estimate);
      EXPECT_LE(error.estimate, error.high);
      EXPECT_GT(error.estimate, truth / 2);
      EXPECT_LT(error.estimate, truth * 2);
    }
  }

  // 95 of 100 hold; that 3 of 12 do not would have a chance of 2 %
  EXPECT_GE(held, runs - 2);
}

TEST(OperatorError, IsNotSeenWhereThereIsNone) {
  const LitRoom room;

  const OperatorError error = room.error_of(room.exact, 1e-3, 0, 5e6);

  EXPECT_EQ(error.low, 0);
  // what the probes can see at all: their noise is about the accuracy
  EXPECT_LT(error.high, 3e-3);
}

TEST(OperatorError, CountsWhatErrorsBringBackByReflection) {
  const LitRoom room;
  // everything 5 % too bright: H - F B is less than half of that, since B is too bright as well
  const RadiositySolution bright = room.with_irradiance(1.05 * room.exact.irradiance);

  const OperatorError error = room.error_of(bright, 0.01);

  EXPECT_LE(error.low, 0.05);
  EXPECT_GE(error.high, 0.05);
  EXPECT_NEAR(error.estimate, 0.05, 0.01);
}

TEST(OperatorError, IsThatOfTheWorstChannel) {
  LitRoom room;
  room.rho = PatchField::Constant(room.mesh.size(), 2, 0.7);
  room.emission = room.emission.replicate(1, 2).eval();
  PatchField irradiance = room.exact.irradiance.replicate(1, 2);
  irradiance.col(1) *= 1.1;

  const OperatorError error = room.error_of(room.with_irradiance(irradiance), 0.02);

  EXPECT_NEAR(error.estimate, 0.1, 0.02);
}

TEST(OperatorError, GivesTheSameBitsForAnyNumberOfThreads) {
  const LitRoom room;
  const auto run = [&] { return room.error_of(room.exact, 0.01, 5, 5e4).estimate; };
  double serial = 0;
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    serial = run();
  }

  EXPECT_EQ(run(), serial);
}

TEST(OperatorError, RefusesFieldsOfAnotherMesh) {
  const LitRoom room;

  EXPECT_THROW(
      operator_error(room.mesh, room.occluders, PatchField::Zero(3, 1), room.emission, room.exact, {}),
      std::invalid_argument);
}

// A dense run that was right to 2e-5 had the second interval.
TEST(OperatorError, IsSurelyAboveAnAccuracyWhereTheIntervalIsNarrow) {
  const OperatorError narrow{.estimate = 0.0056, .low = 0.0040, .high = 0.0071};
  const OperatorError wide{.estimate = 0.0016, .low = 0.00044, .high = 0.0030};

  EXPECT_TRUE(narrow.surely_above(0.0039));
  EXPECT_FALSE(narrow.surely_above(0.0041));
  EXPECT_FALSE(wide.surely_above(1e-4));
}

}  // namespace
}  // namespace luxel
