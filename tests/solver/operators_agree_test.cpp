// Dense, gather and hierarchical share neither form factors nor the way that they meet lamps: held against
// each other where lamps are awkward to aim at.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "luxel/dense_operator.h"
#include "luxel/form_factors.h"
#include "luxel/gather_operator.h"
#include "luxel/hierarchical_operator.h"
#include "luxel/operator_error.h"
#include "solver/gather_scenes.h"

namespace luxel {
namespace {

using namespace luxel::testing;

constexpr double accuracy = 0.015;

// Of dense, whose error is far below: it stands for the truth.
constexpr double accurate = 1e-4;

// A single patch may be off by so many times the RMS that was asked for, relative to the RMS irradiance: of
// 200 patches the worst is at 3 standard deviations if errors are alike, and they differ by 3 between bright
// and dark ones.
constexpr double single_patch = 9;

// Of two dozen intervals one may miss the error, but not by so much.
constexpr double beyond = 2;

/// A unit room with two boxes, faces 0 to 5 (floor, ceiling, front, back, left, right), 6 to 11 and 12 to 17.
struct LampRoom {
  Boxes boxes = Boxes().add({0, 0, 0}, {1, 1, 1}, true);
  std::function<double(int face, int cell)> exitance;  // cell: of 9

  /// A box around a place, turned about its middle.
  void add_box(const Vec3& middle, const Vec3& half, double about_x, double about_z) {
    boxes.add(-half, half, false);
    const Eigen::Matrix3d turn =
        (Eigen::AngleAxisd(about_z, Vec3::UnitZ()) * Eigen::AngleAxisd(about_x, Vec3::UnitX()))
            .toRotationMatrix();
    for (std::size_t v = boxes.vertices.size() - 8; v < boxes.vertices.size(); ++v) {
      boxes.vertices[v] = middle + turn * boxes.vertices[v];
    }
  }
};

class AwkwardLamps : public ::testing::TestWithParam<int> {
 protected:
  std::mt19937 random{static_cast<unsigned>(GetParam())};

  double between(double low, double high) { return std::uniform_real_distribution(low, high)(random); }

  /// Two boxes somewhere, turned about the upright.
  LampRoom room() {
    LampRoom room;
    room.add_box({between(0.25, 0.35), between(0.25, 0.7), 0.3}, {0.12, 0.1, 0.2}, 0, between(0, 1));
    room.add_box({between(0.65, 0.75), between(0.25, 0.7), 0.6}, {0.1, 0.13, 0.15}, 0, between(0, 1));
    return room;
  }

  void expect_agreement(const LampRoom& room) {
    const PatchMesh mesh = cut_faces(room.boxes, 3);
    PatchField rho = PatchField::Constant(mesh.size(), 1, 0.5), emission = PatchField::Zero(mesh.size(), 1);
    for (int i = 0; i < mesh.size(); ++i) emission(i, 0) = room.exitance(mesh.faces[i], i % 9);
    const RayScene occluders(mesh.occluders);
    const Enclosures enclosures = find_enclosures(mesh, occluders);
    FormFactorOptions factors;
    factors.accuracy = accurate;
    const ClosedOperator dense =
        close_rows(form_factors(mesh, factors).exchange_areas, mesh.areas, enclosures);
    const PatchField exact = solve(*dense.transport, rho, emission).irradiance;

    GatherOptions gathering;
    gathering.accuracy = accuracy;
    HierarchicalOptions clustering;
    clustering.accuracy = accuracy;
    const RadiositySolution gathered = solve_gathered(mesh, occluders, rho, emission, gathering).light;
    const RadiositySolution clustered = solve_hierarchical(mesh, enclosures, rho, emission, clustering).light;

    double mean_square = 0, area = 0;
    for (int i = 0; i < mesh.size(); ++i) {
      mean_square += mesh.areas[i] * exact(i, 0) * exact(i, 0);
      area += mesh.areas[i];
    }
    const double rms = std::sqrt(mean_square / area);
    for (const auto* light : {&gathered, &clustered}) {
      const std::string which = light == &gathered ? "gather" : "hierarchical";
      OperatorErrorOptions probing;
      probing.accuracy = accuracy;
      probing.seed = static_cast<std::uint64_t>(GetParam());
      probing.most_rays = 5e4;
      const OperatorError bar = operator_error(mesh, occluders, rho, emission, *light, {}, probing);
      const double off = relative_rms(mesh, light->irradiance, exact);
      EXPECT_LE(off, beyond * bar.high + accurate) << which;
      EXPECT_GE(off, bar.low / beyond - accurate) << which;
      EXPECT_LE(bar.low, accuracy) << which;
      EXPECT_LE((light->irradiance - exact).cwiseAbs().maxCoeff() / rms, single_patch * accuracy) << which;
    }
  }
};

TEST_P(AwkwardLamps, OfWhichMostLiesBehindAPatch) {
  LampRoom room;
  room.add_box({0.5, 0.5, 0.95}, {0.42, 0.42, 0.02}, 0, 0);
  // an upright side that sees a strip of it
  const double strip = between(0.01, 0.03);
  room.add_box({0.92 - strip - 0.15, between(0.4, 0.6), 0.72}, {0.15, 0.15, 0.15}, 0, 0);
  room.exitance = [](int face, int) { return face == 6 ? 2.0 : 0.0; };

  expect_agreement(room);
}

TEST_P(AwkwardLamps, BelowTheHorizonAndCoplanarWithPatches) {
  LampRoom room = this->room();
  const int lamp = std::uniform_int_distribution(0, 8)(random);
  room.exitance = [&](int face, int cell) { return face == 0 && cell == lamp ? 10.0 : 0.0; };

  expect_agreement(room);
}

TEST_P(AwkwardLamps, BehindABlock) {
  LampRoom room;
  room.add_box({0.5, 0.5, between(0.84, 0.86)}, {0.16, 0.16, 0.1}, 0, between(0, 1));
  room.add_box({between(0.3, 0.7), 0.4, 0.4}, {0.1, 0.15, 0.1}, between(0, 1), 0);
  room.exitance = [](int face, int cell) { return face == 1 && cell == 4 ? 10.0 : 0.0; };

  expect_agreement(room);
}

TEST_P(AwkwardLamps, CutByThePlanesOfPatches) {
  LampRoom room = this->room();
  room.exitance = [](int face, int) { return face == 4 ? 1.0 : 0.0; };

  expect_agreement(room);
}

TEST_P(AwkwardLamps, ManyAndSmall) {
  LampRoom room = this->room();
  std::array<double, 18 * 9> values{};
  for (int k = 0; k < 20; ++k) values[std::uniform_int_distribution(0, 18 * 9 - 1)(random)] = between(1, 9);
  room.exitance = [&](int face, int cell) { return values[9 * face + cell]; };

  expect_agreement(room);
}

TEST_P(AwkwardLamps, TiltedAndCloseToAWall) {
  LampRoom room;
  room.add_box({0.16, between(0.3, 0.7), 0.5}, {0.15, 0.15, 0.02}, between(0.3, 1), between(-0.2, 0));
  room.add_box({0.7, between(0.3, 0.7), 0.5}, {0.1, 0.15, 0.1}, between(0, 1), between(0, 1));
  room.exitance = [](int face, int) { return face >= 6 && face < 12 ? 3.0 : 0.0; };

  expect_agreement(room);
}

INSTANTIATE_TEST_SUITE_P(Operators, AwkwardLamps, ::testing::Values(1, 2));

}  // namespace
}  // namespace luxel
