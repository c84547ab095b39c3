#include "weld.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "meshing/scenes.h"

namespace luxel {
namespace {

/// Unshared triangles of a lattice of n x n squares of side 1, corners moved by up to `jitter`.
Scene loose_lattice(int n, double jitter) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(-jitter, jitter);
  SceneMaker maker;
  const auto corner = [&](int x, int y) { return Vec3(x + shift(random), y + shift(random), shift(random)); };
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      maker.face({corner(x, y), corner(x + 1, y), corner(x + 1, y + 1)});
      maker.face({corner(x, y), corner(x + 1, y + 1), corner(x, y + 1)});
    }
  }
  return maker.scene();
}

TEST(Weld, JoinsCornersThatRoundingHasMovedApart) {
  const Scene scene = loose_lattice(50, 1e-8);  // the diagonal is 71: 7e-7 is joined

  const WeldedVertices welded = weld(scene);

  EXPECT_EQ(welded.positions.size(), 51u * 51u);
  EXPECT_EQ(welded.welded, 6 * 50 * 50 - 51 * 51);
  for (std::size_t v = 0; v < scene.vertices.size(); ++v) {
    EXPECT_LT((welded.positions[welded.index[v]] - scene.vertices[v]).norm(), 1e-7);
  }
}

TEST(Weld, KeepsCornersApartThatAreFurtherThanItsDistance) {
  const Scene scene = loose_lattice(20, 1e-4);  // joined is what is within 3e-7

  EXPECT_EQ(weld(scene).positions.size(), 6u * 20u * 20u);
}

TEST(Weld, PutsPositionsInTheOrderThatFacesUseThem) {
  SceneMaker maker;
  maker.face({{5, 0, 0}, {1, 0, 0}, {0, 3, 0}}).face({{0, 3, 0}, {1, 0, 0}, {-4, 0, 1}});

  const WeldedVertices welded = weld(maker.scene());

  const std::vector<Vec3> expected = {{5, 0, 0}, {1, 0, 0}, {0, 3, 0}, {-4, 0, 1}};
  EXPECT_EQ(welded.positions, expected);
  EXPECT_EQ(welded.index, (std::vector<int>{0, 1, 2, 2, 1, 3}));
}

TEST(Weld, JoinsAnyNumberOfVerticesAtOnePlaceAndLeavesOutUnusedOnes) {
  SceneMaker maker;  // a fan of 500 triangles around one point
  for (int k = 0; k < 500; ++k) {
    maker.face({{0, 0, 0}, {std::cos(k * 0.01), std::sin(k * 0.01), 0}, {0, 0, 1.0 + k}});
  }
  Scene scene = maker.scene();
  scene.vertices.emplace_back(0, 0, 0);

  const WeldedVertices welded = weld(scene);

  EXPECT_EQ(welded.positions.size(), 1u + 500u + 500u);
  EXPECT_EQ(welded.index.back(), -1);
}

TEST(Weld, JoinsAllThatLiesInOnePoint) {
  SceneMaker maker;
  maker.face({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});

  EXPECT_EQ(weld(maker.scene()).positions.size(), 1u);
}

}  // namespace
}  // namespace luxel
