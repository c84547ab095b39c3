#include "luxel/enclosures.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <tuple>

#include "luxel/input_error.h"
#include "solver/hand_made_mesh.h"

namespace luxel {
namespace {

using testing::Boxes;
using testing::hand_made_mesh;

Enclosures enclosures_of(const PatchMesh& mesh, int rays = 256) {
  return find_enclosures(mesh, RayScene(mesh.occluders), rays);
}

class EnclosuresAtAnyScale : public ::testing::TestWithParam<std::tuple<double, double>> {
 protected:
  double scale = std::get<0>(GetParam());
  Vec3 offset = std::get<1>(GetParam()) * scale * Vec3(1, -0.7, 0.3);
};

TEST_P(EnclosuresAtAnyScale, ABoxSeenFromInsideIsOneClosedEnclosure) {
  const Enclosures found = enclosures_of(Boxes().add({0, 0, 0}, {1, 2, 3}, true).moved(scale, offset).mesh());

  EXPECT_TRUE(found.closed);
  EXPECT_EQ(found.count, 1);
  for (double share : found.open_share) EXPECT_EQ(share, 0);
  for (double share : found.back_share) EXPECT_EQ(share, 0);
  for (double error : found.share_error) EXPECT_EQ(error, 0);
}

TEST_P(EnclosuresAtAnyScale, RoomsBehindAWallOfAMillionthAreTwo) {
  const double gap = 1e-6 * std::sqrt(6.0);
  const Enclosures found = enclosures_of(Boxes()
                                             .add({0, 0, 0}, {1, 1, 1}, true)
                                             .add({1 + gap, 0, 0}, {2, 1, 1}, true)
                                             .moved(scale, offset)
                                             .mesh());

  EXPECT_TRUE(found.closed);
  EXPECT_EQ(found.count, 2);
  for (int i = 0; i < 12; ++i) EXPECT_EQ(found.enclosure[i], i / 6);
}

INSTANTIATE_TEST_SUITE_P(ScaleAndOffset, EnclosuresAtAnyScale,
                         ::testing::Combine(::testing::Values(1e-6, 1.0, 1e6),
                                            ::testing::Values(0.0, 1e6, 1e8)));

TEST(Enclosures, ARoomWithAFloatingBodyIsOneClosedEnclosure) {
  const Enclosures found = enclosures_of(
      Boxes().add({0, 0, 0}, {1, 1, 1}, true).add({0.31, 0.27, 0.22}, {0.63, 0.58, 0.71}, false).mesh());

  EXPECT_TRUE(found.closed);
  EXPECT_EQ(found.count, 1);
}

TEST(Enclosures, ABoxSeenFromOutsideIsOpenAndItsSidesAreAlone) {
  const Enclosures found = enclosures_of(Boxes().add({0, 0, 0}, {1, 1, 1}, false).mesh());

  EXPECT_FALSE(found.closed);
  EXPECT_EQ(found.count, 6);
  for (double share : found.open_share) EXPECT_EQ(share, 1);
  for (double error : found.share_error) EXPECT_EQ(error, 0);  // every ray agrees
}

TEST(Enclosures, ABoxWithAFlippedWallIsNotClosed) {
  Boxes box = Boxes().add({0, 0, 0}, {1, 1, 1}, true);
  std::swap(box.faces[3][1], box.faces[3][3]);
  const Enclosures found = enclosures_of(box.mesh());

  EXPECT_FALSE(found.closed);
  EXPECT_EQ(found.count, 2);  // the flipped wall sees nobody
  EXPECT_EQ(found.open_share[3], 1);
  EXPECT_EQ(found.back_share[3], 0);
  // opposite and adjacent sides of a cube: F = 0.199825 and 0.200044 (Howell's catalogue C-11, C-14)
  EXPECT_NEAR(found.back_share[2], 0.199825, 4 * found.share_error[2]);
  EXPECT_NEAR(found.back_share[0], 0.200044, 4 * found.share_error[0]);
  EXPECT_LT(found.share_error[0], 0.025);  // that of 256 independent rays
  EXPECT_EQ(found.open_share[0], 0);
}

TEST(Enclosures, ABoxWithoutLidLosesTheShareOfTheLid) {
  Boxes box = Boxes().add({0, 0, 0}, {1, 1, 1}, true);
  box.faces.erase(box.faces.begin() + 1);
  const Enclosures found = enclosures_of(box.mesh(), 4096);

  EXPECT_FALSE(found.closed);
  EXPECT_EQ(found.count, 1);
  EXPECT_NEAR(found.open_share[0], 0.199825, 4 * found.share_error[0]);
  for (int i = 1; i < 5; ++i) EXPECT_NEAR(found.open_share[i], 0.200044, 4 * found.share_error[i]);
  for (double error : found.share_error) EXPECT_LT(error, 0.00625);  // that of 4096 independent rays
}

TEST(Enclosures, CoincidentSheetsPartTheRoomsThatTheyFace) {
  // one wall, two patches back to back, standing once among the occluders
  Boxes rooms = Boxes().add({0, 0, 0}, {1, 1, 1}, true).add({1, 0, 0}, {2, 1, 1}, true);
  PatchMesh mesh = rooms.mesh();
  // box 1's left wall (patch 6 + 4) moves into the polygon of box 0's right wall (patch 5)
  mesh.polygons[10] = mesh.polygons[5];
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> polygons;
  for (std::size_t t = 0; t < mesh.occluders.triangles.size(); ++t) {
    if (mesh.occluders.polygons[t] == 10) continue;
    triangles.push_back(mesh.occluders.triangles[t]);
    polygons.push_back(mesh.occluders.polygons[t]);
  }
  mesh.occluders.triangles = triangles;
  mesh.occluders.polygons = polygons;

  const Enclosures found = enclosures_of(mesh);

  EXPECT_TRUE(found.closed);
  EXPECT_EQ(found.count, 2);
  for (int i = 0; i < 12; ++i) EXPECT_EQ(found.enclosure[i], i / 6);
}

TEST(Enclosures, AreTheSameForAnyNumberOfThreads) {
  const PatchMesh mesh = Boxes().add({0, 0, 0}, {1, 1, 1}, false).add({1.2, 0.1, 0}, {2, 1, 1}, false).mesh();
  const Enclosures more = enclosures_of(mesh);

  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  const Enclosures one = enclosures_of(mesh);

  EXPECT_EQ(one.enclosure, more.enclosure);
  EXPECT_EQ(one.open_share, more.open_share);
  EXPECT_EQ(one.share_error, more.share_error);
}

TEST(Enclosures, StopWhenAsked) {
  const PatchMesh mesh = Boxes().add({0, 0, 0}, {1, 1, 1}, false).mesh();
  const RayScene scene(mesh.occluders);

  EXPECT_THROW(find_enclosures(mesh, scene, 256, [](auto, double, double) { return false; }), Cancelled);
}

TEST(Enclosures, RefuseTooFewRays) {
  const PatchMesh mesh = Boxes().add({0, 0, 0}, {1, 1, 1}, true).mesh();

  EXPECT_THROW(enclosures_of(mesh, 15), std::invalid_argument);
}

}  // namespace
}  // namespace luxel
