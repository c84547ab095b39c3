#include "luxel/ray_scene.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>
#include <tuple>

#include "solver/hand_made_mesh.h"

namespace luxel {
namespace {

using testing::Boxes;
using testing::hand_made_mesh;

/// Rays of one kind that a test gathers and shoots together.
struct Rays {
  std::vector<Vec3> origins, normals, directions;
  void add(const Vec3& origin, const Vec3& normal, const Vec3& direction) {
    origins.push_back(origin);
    normals.push_back(normal);
    directions.push_back(direction.normalized());
  }
  std::vector<RayScene::Hit> shoot(const RayScene& scene) const {
    std::vector<RayScene::Hit> hits(origins.size());
    scene.intersect(origins, normals, directions, hits);
    return hits;
  }
};

/// Points of a patch and directions into its front hemisphere, both uniformly random.
Rays random_rays(const PatchMesh& mesh, int per_patch, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  Rays rays;
  for (int i = 0; i < mesh.size(); ++i) {
    const auto& c = mesh.corners[i];
    const Vec3 a = mesh.vertices[c[0]];
    const Vec3 u = mesh.vertices[c[1]] - a, v = mesh.vertices[c[3] < 0 ? c[2] : c[3]] - a;
    for (int k = 0; k < per_patch; ++k) {
      double s = unit(random), t = unit(random);
      if (c[3] < 0 && s + t > 1) s = 1 - s, t = 1 - t;
      Vec3 d(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5);
      if (d.dot(mesh.normals[i]) < 0) d -= 2 * d.dot(mesh.normals[i]) * mesh.normals[i];
      rays.add(a + s * u + t * v, mesh.normals[i], d);
    }
  }
  return rays;
}

class RaySceneAtAnyScale : public ::testing::TestWithParam<std::tuple<double, double>> {
 protected:
  double scale = std::get<0>(GetParam());
  Vec3 offset = std::get<1>(GetParam()) * scale * Vec3(1, -0.7, 0.3);
};

TEST_P(RaySceneAtAnyScale, NoRayLeavesAClosedBox) {
  const PatchMesh mesh = Boxes().add({0, 0, 0}, {1, 2, 3}, true).moved(scale, offset).mesh();
  const RayScene scene(mesh.occluders);

  const auto hits = random_rays(mesh, 20'000, 1).shoot(scene);

  for (const auto& hit : hits) ASSERT_TRUE(hit.front);
}

TEST_P(RaySceneAtAnyScale, DistancesAreThoseOfTheBox) {
  const PatchMesh mesh = Boxes().add({0, 0, 0}, {1, 1, 1}, true).moved(scale, offset).mesh();
  const RayScene scene(mesh.occluders);
  Rays rays;
  for (int i = 0; i < mesh.size(); ++i) rays.add(mesh.centroids[i], mesh.normals[i], mesh.normals[i]);

  const auto hits = rays.shoot(scene);

  // the coordinates themselves round at 1e-16 of the offset
  const double tolerance = scale * (1e-12 + 1e-15 * std::abs(std::get<1>(GetParam())));
  for (const auto& hit : hits) EXPECT_NEAR(hit.distance, scale, tolerance);
}

// at 1e8 the coordinates round at 1.5e-8 of the box, which a gap of 1e-6 still stands
INSTANTIATE_TEST_SUITE_P(ScaleAndOffset, RaySceneAtAnyScale,
                         ::testing::Combine(::testing::Values(1e-6, 1.0, 1e6),
                                            ::testing::Values(0.0, 1e3, 1e6, 1e8)));

TEST_P(RaySceneAtAnyScale, AWallOfAMillionthNeitherLeaksNorShadowsItself) {
  // two rooms, side by side, with a wall of 1e-6 of the diagonal between them, solid inside
  const double gap = 1e-6 * std::sqrt(6.0);
  const PatchMesh mesh = Boxes()
                             .add({0, 0, 0}, {1, 1, 1}, true)
                             .add({1 + gap, 0, 0}, {2, 1, 1}, true)
                             .moved(scale, offset)
                             .mesh();
  const RayScene scene(mesh.occluders);

  const Rays rays = random_rays(mesh, 20'000, 2);
  const auto hits = rays.shoot(scene);

  for (std::size_t k = 0; k < hits.size(); ++k) {
    ASSERT_TRUE(hits[k].front);
    const bool starts_left = k < hits.size() / 2;
    const int polygon = mesh.occluders.polygons[hits[k].primitive];
    ASSERT_EQ(polygon < 6, starts_left);
    ASSERT_NE(polygon, static_cast<int>(k / 20'000));  // flat patches do not see themselves
  }
}

TEST_P(RaySceneAtAnyScale, RaysCrossAGapOfAMillionth) {
  // two plates face each other across 1e-6 of the diagonal; the rays go straight over
  const double gap = 1e-6 * std::sqrt(2.0);
  std::vector<Vec3> vertices{{0, 0, 0},   {1, 0, 0},   {1, 1, 0},   {0, 1, 0},
                             {0, 0, gap}, {0, 1, gap}, {1, 1, gap}, {1, 0, gap}};
  for (Vec3& x : vertices) x = scale * x + offset;
  const PatchMesh mesh = hand_made_mesh(vertices, {{0, 1, 2, 3}, {4, 5, 6, 7}});
  const RayScene scene(mesh.occluders);
  Rays rays = random_rays(mesh, 5'000, 3);
  for (std::size_t k = 0; k < rays.directions.size(); ++k) rays.directions[k] = rays.normals[k];

  const auto hits = rays.shoot(scene);

  for (std::size_t k = 0; k < hits.size(); ++k) {
    ASSERT_TRUE(hits[k].front);
    ASSERT_EQ(mesh.occluders.polygons[hits[k].primitive], k < 5'000 ? 1 : 0);
    // input rounding at the offset, each coordinate
    ASSERT_NEAR(hits[k].distance, gap * scale, scale * (1e-12 + 1e-15 * std::abs(std::get<1>(GetParam()))));
  }
}

TEST(RayScene, RaysAimedAtEdgesAndCornersNeverLeaveAClosedBox) {
  // turned, so that no edge runs along an axis and every coordinate rounds
  Boxes box = Boxes().add({-0.5, -0.4, -0.3}, {0.5, 0.4, 0.3}, true);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  for (Vec3& x : box.vertices) x = turn * x;
  const PatchMesh mesh = box.mesh();
  const RayScene scene(mesh.occluders);
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> unit(0, 1);
  Rays rays;
  for (int i = 0; i < mesh.size(); ++i) {
    for (int a = 0; a < 8; ++a) {
      for (int b = 0; b <= a; ++b) {  // all edges, diagonals and corners (a = b)
        for (int k = 0; k < 300; ++k) {
          const double t = unit(random);
          const Vec3 target = (1 - t) * mesh.vertices[a] + t * mesh.vertices[b];
          const auto& c = mesh.corners[i];
          const Vec3 origin =
              mesh.centroids[i] + 0.9 * (unit(random) - 0.5) * (mesh.vertices[c[1]] - mesh.vertices[c[0]]);
          if ((target - origin).dot(mesh.normals[i]) < 1e-9) continue;
          rays.add(origin, mesh.normals[i], target - origin);
        }
      }
    }
  }

  const auto hits = rays.shoot(scene);

  for (const auto& hit : hits) ASSERT_TRUE(hit.front);
}

TEST(RayScene, RaysThatStartBesideAnEdgeStayInside) {
  // a wedge of 10 degrees: floor and roof meet in the y axis; closed by the end wall and two sides
  const double height = std::tan(10 * std::numbers::pi / 180);
  const std::vector<Vec3> vertices{{0, 0, 0}, {0, 1, 0},      {1, 0, 0},
                                   {1, 1, 0}, {1, 0, height}, {1, 1, height}};
  const PatchMesh mesh =
      hand_made_mesh(vertices, {{0, 2, 3, 1}, {0, 1, 5, 4}, {2, 4, 5, 3}, {0, 4, 2, -1}, {1, 3, 5, -1}});
  const RayScene scene(mesh.occluders);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  Rays rays;
  for (int k = 0; k < 100'000; ++k) {
    const double from_edge = std::pow(10, -12 * unit(random));
    const double azimuth = 2 * std::numbers::pi * unit(random), rise = unit(random);
    rays.add({from_edge, 0.1 + 0.8 * unit(random), 0}, Vec3::UnitZ(),
             {std::cos(azimuth) * (1 - rise), std::sin(azimuth) * (1 - rise), rise + 1e-6});
  }

  const auto hits = rays.shoot(scene);

  for (const auto& hit : hits) ASSERT_TRUE(hit.front);
}

TEST(RayScene, TheSideIsTheOneThatFacesTheRay) {
  const PatchMesh mesh = hand_made_mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2, 3}});
  const RayScene scene(mesh.occluders);
  Rays rays;
  rays.add({0.3, 0.4, 2}, -Vec3::UnitZ(), -Vec3::UnitZ());
  rays.add({0.3, 0.4, -2}, Vec3::UnitZ(), Vec3::UnitZ());
  rays.add({0.3, 0.4, 2}, Vec3::UnitZ(), Vec3::UnitZ());

  const auto hits = rays.shoot(scene);

  EXPECT_TRUE(hits[0].front);
  EXPECT_FALSE(hits[1].front);
  EXPECT_GE(hits[1].primitive, 0);
  EXPECT_EQ(hits[2].primitive, -1);
}

TEST(RayScene, ACameraFarAwaySeesAsSharplyAsOneNear) {
  const PatchMesh mesh = Boxes().add({0, 0, 0}, {1, 1, 1}, false).mesh();
  const RayScene scene(mesh.occluders);
  Rays rays;
  for (double distance : {1e1, 1e3, 1e5}) {
    const Vec3 eye = Vec3(0.25, 0.5, 1 + distance);
    rays.add(eye, -Vec3::UnitZ(), -Vec3::UnitZ());
  }

  const auto hits = rays.shoot(scene);

  EXPECT_NEAR(hits[0].distance, 1e1, 1e-9);
  EXPECT_NEAR(hits[1].distance, 1e3, 1e-9);
  EXPECT_NEAR(hits[2].distance, 1e5, 1e-9);
}

TEST(RayScene, OfPatchesNamesPatchAndHalf) {
  const PatchMesh mesh =
      hand_made_mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}}, {{0, 1, 2, 3}, {1, 4, 2, -1}});
  const RayScene scene(mesh);
  Rays rays;
  for (const Vec3& x : {Vec3(0.7, 0.2, 1), Vec3(0.2, 0.7, 1), Vec3(1.3, 0.2, 1)}) {
    rays.add(x, -Vec3::UnitZ(), -Vec3::UnitZ());
  }

  const auto hits = rays.shoot(scene);

  EXPECT_EQ(hits[0].primitive, 0);
  EXPECT_EQ(hits[1].primitive, 0 | RayScene::second_half);
  EXPECT_EQ(hits[2].primitive, 1);
  EXPECT_NEAR(hits[1].u, 0.2, 1e-6);  // float
  EXPECT_NEAR(hits[1].v, 0.5, 1e-6);
}

TEST(RayScene, OfPatchesMeetsTheSheetThatFacesTheRay) {
  // two sheets in one place, back to back and cut differently
  const PatchMesh mesh = hand_made_mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                                        {{0, 1, 2, 3}, {1, 0, 3, -1}, {3, 2, 1, -1}});
  const RayScene scene(mesh);
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> unit(0, 1);
  Rays rays;
  for (int k = 0; k < 10'000; ++k) {
    const double side = k % 2 ? 1 : -1;
    const Vec3 origin(3 * unit(random) - 1, 3 * unit(random) - 1, side);
    const Vec3 target(unit(random), unit(random), 0);
    rays.add(origin, (target - origin).normalized(), target - origin);
  }

  const auto hits = rays.shoot(scene);

  for (int k = 0; k < 10'000; ++k) {
    ASSERT_TRUE(hits[k].front);
    ASSERT_EQ((hits[k].primitive & ~RayScene::second_half) == 0, k % 2 == 1);
  }
}

TEST(RayScene, WithoutTrianglesEveryRayEscapes) {
  const RayScene scene{Occluders()};
  Rays rays;
  rays.add({0, 0, 0}, Vec3::UnitZ(), Vec3::UnitZ());

  EXPECT_EQ(rays.shoot(scene)[0].primitive, -1);
}

TEST(RayScene, RefusesSpansOfDifferentLength) {
  const RayScene scene{Occluders()};
  std::vector<Vec3> two(2, Vec3::UnitZ());
  std::vector<RayScene::Hit> one(1);

  EXPECT_THROW(scene.intersect(two, two, two, one), std::invalid_argument);
}

}  // namespace
}  // namespace luxel
