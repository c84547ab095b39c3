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

/// Replaces the face at `index` by a frame of four around a square hole of this side in its middle.
void cut_hole(Boxes& boxes, int index, double side) {
  const auto face = boxes.faces[index];
  Vec3 middle = Vec3::Zero();
  for (int corner : face) middle += boxes.vertices[corner] / 4;
  const int first = static_cast<int>(boxes.vertices.size());
  const double edge = (boxes.vertices[face[1]] - boxes.vertices[face[0]]).norm();
  for (int corner : face) {
    const Vec3 toward = boxes.vertices[corner] - middle;
    boxes.vertices.push_back(middle + side / edge * toward);
  }
  boxes.faces.erase(boxes.faces.begin() + index);
  for (int k = 0; k < 4; ++k) {
    const int next = (k + 1) % 4;
    boxes.faces.push_back({face[k], face[next], first + next, first + k});
  }
}

/// A unit room with a square hole in its right wall.
Boxes room_with_a_hole(double side) {
  Boxes room = Boxes().add({0, 0, 0}, {1, 1, 1}, true);
  cut_hole(room, 5, side);
  return room;
}

/// Two rooms side by side whose common wall stands once, with patches on both sides; a hole in it if side >
/// 0.
Boxes rooms_with_a_hole(double side) {
  Boxes rooms = Boxes().add({0, 0, 0}, {1, 1, 1}, true).add({1, 0, 0}, {2, 1, 1}, true);
  // corners 1, 3, 5, 7 of the left box are 0, 2, 4, 6 of the right one
  for (auto& face : rooms.faces) {
    for (int& corner : face) {
      if (corner >= 8 && corner % 2 == 0) corner -= 7;
    }
  }
  if (side == 0) return rooms;
  cut_hole(rooms, 5, side);
  // the right room's wall becomes the reverse of the frame
  rooms.faces.erase(rooms.faces.begin() + 9);
  const std::size_t frame = rooms.faces.size() - 4;
  for (int k = 0; k < 4; ++k) {
    const auto c = rooms.faces[frame + k];
    rooms.faces.push_back({c[0], c[3], c[2], c[1]});
  }
  return rooms;
}

/// Two rooms a unit apart, joined by a tunnel of square section through the solid between them.
Boxes rooms_with_a_tunnel(double side) {
  Boxes rooms = Boxes().add({0, 0, 0}, {1, 1, 1}, true).add({2, 0, 0}, {3, 1, 1}, true);
  cut_hole(rooms, 5, side);
  const int left = static_cast<int>(rooms.vertices.size()) - 4;
  cut_hole(rooms, 9, side);
  const int right = static_cast<int>(rooms.vertices.size()) - 4;
  // match the corners of the two holes, then face inwards
  std::array<int, 4> across{};
  for (int k = 0; k < 4; ++k) {
    for (int l = 0; l < 4; ++l) {
      const Vec3 apart = rooms.vertices[right + l] - rooms.vertices[left + k];
      if (apart.tail<2>().norm() < side / 4) across[k] = right + l;
    }
  }
  for (int k = 0; k < 4; ++k) {
    const int next = (k + 1) % 4;
    rooms.faces.push_back({left + k, left + next, across[next], across[k]});
  }
  return rooms;
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
  for (double error : found.share_error) EXPECT_EQ(error, 1.0 / 256);  // every ray agrees
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

TEST(Enclosures, MeasureSharesAsWellAsAsked) {
  Boxes box = Boxes().add({0, 0, 0}, {1, 1, 1}, true);
  box.faces.erase(box.faces.begin() + 1);
  const PatchMesh mesh = box.mesh();
  const Enclosures found = find_enclosures(mesh, RayScene(mesh.occluders), 256, {}, 1e-3);

  EXPECT_NEAR(found.open_share[0], 0.199825, 4e-3);
  for (int i = 1; i < 5; ++i) EXPECT_NEAR(found.open_share[i], 0.200044, 4e-3);
  // the forecast of rays is good to a factor of 1.5 in error or so
  for (double error : found.share_error) EXPECT_LT(error, 1.5e-3);
  EXPECT_LT(found.rays, 5 * 256 * 65);
}

TEST(MeasureShares, BringsTheErrorsOfOpenEnclosuresDownToTheAccuracy) {
  Boxes boxes = Boxes().add({0, 0, 0}, {1, 1, 1}, true);
  boxes.faces.erase(boxes.faces.begin() + 1);
  boxes.add({3, 0, 0}, {4, 1, 1}, true);
  const PatchMesh mesh = boxes.mesh();
  const RayScene scene(mesh.occluders);
  Enclosures found = find_enclosures(mesh, scene);
  const std::int64_t before = found.rays;

  measure_shares(found, mesh, scene, 1e-3, 1'000'000);

  // Howell C-11 and C-14; errors are forecast to a factor of 1.5
  EXPECT_NEAR(found.open_share[0], 0.199825, 4e-3);
  for (int i = 1; i < 5; ++i) EXPECT_NEAR(found.open_share[i], 0.200044, 4e-3);
  for (int i = 0; i < 5; ++i) EXPECT_LT(found.share_error[i], 1.5e-3);
  for (int i = 5; i < 11; ++i) EXPECT_EQ(found.share_error[i], 0);
  EXPECT_GT(found.rays, before);
  EXPECT_LE(found.rays, before + 5 * 64 * 256);
}

TEST(MeasureShares, CastsNoMoreRaysThanAllowed) {
  Boxes box = Boxes().add({0, 0, 0}, {1, 1, 1}, true);
  box.faces.erase(box.faces.begin() + 1);
  const PatchMesh mesh = box.mesh();
  const RayScene scene(mesh.occluders);
  Enclosures found = find_enclosures(mesh, scene);
  const std::int64_t before = found.rays;

  measure_shares(found, mesh, scene, 1e-5, 5 * 1024);

  EXPECT_EQ(found.rays, before + 5 * 1024);
  EXPECT_THROW(measure_shares(found, mesh, scene, 0, 5 * 1024), std::invalid_argument);
}

TEST(Enclosures, CoincidentSheetsPartTheRoomsThatTheyFace) {
  const Enclosures found = enclosures_of(rooms_with_a_hole(0).mesh());

  EXPECT_TRUE(found.closed);
  EXPECT_EQ(found.count, 2);
  for (int i = 0; i < 12; ++i) EXPECT_EQ(found.enclosure[i], i / 6);
}

TEST(Enclosures, NeedNoRaysWhereTheSurfacesCloseByTheirEdges) {
  EXPECT_EQ(enclosures_of(Boxes().add({0, 0, 0}, {1, 1, 1}, true).mesh()).rays, 0);
  EXPECT_EQ(enclosures_of(rooms_with_a_hole(0).mesh()).rays, 0);
  EXPECT_EQ(enclosures_of(
                Boxes().add({0, 0, 0}, {1, 1, 1}, true).add({0.3, 0.3, 0.2}, {0.6, 0.6, 0.7}, false).mesh())
                .rays,
            0);
}

class EnclosuresWithAHole : public ::testing::TestWithParam<double> {};

TEST_P(EnclosuresWithAHole, RoomsOnBothSidesAreOne) {
  const Enclosures found = enclosures_of(rooms_with_a_hole(GetParam()).mesh());

  EXPECT_TRUE(found.closed);
  EXPECT_EQ(found.count, 1);
}

TEST_P(EnclosuresWithAHole, ARoomIsNotClosed) {
  const Enclosures found = enclosures_of(room_with_a_hole(GetParam()).mesh());

  EXPECT_FALSE(found.closed);
  EXPECT_EQ(found.count, 1);
}

TEST_P(EnclosuresWithAHole, ATunnelJoinsTwoRooms) {
  const Enclosures found = enclosures_of(rooms_with_a_tunnel(GetParam()).mesh());

  EXPECT_TRUE(found.closed);
  EXPECT_EQ(found.count, 1);
}

// the side of the hole, in units of the room; the first is 1e-6 of the diagonal of two rooms and a tunnel
INSTANTIATE_TEST_SUITE_P(Sizes, EnclosuresWithAHole, ::testing::Values(3.4e-6, 1e-5, 1e-3, 0.1, 0.9));

TEST(Enclosures, ABodyOnAnUncutFloorLeavesTheRoomClosed) {
  // a box without a bottom; the floor below it is one patch with the rest, and sees the box's inside
  Boxes room = Boxes().add({0, 0, 0}, {1, 1, 1}, true).add({0.3, 0.3, 0}, {0.6, 0.6, 0.5}, false);
  room.faces.erase(room.faces.begin() + 6);
  const Enclosures found = enclosures_of(room.mesh(), 4096);

  EXPECT_EQ(found.count, 1);
  EXPECT_FALSE(found.closed);
  // the floor sees the inside with the share of the area that it covers; nothing else does
  EXPECT_NEAR(found.back_share[0], 0.09, 4 * found.share_error[0]);
  for (int i = 1; i < 11; ++i) EXPECT_EQ(found.back_share[i] + found.open_share[i], 0) << i;
  EXPECT_EQ(found.open_share[0], 0);
}

TEST(Enclosures, ABodyThatPokesThroughTheFloorIsSeenFromBelow) {
  const Enclosures found = enclosures_of(
      Boxes().add({0, 0, 0}, {1, 1, 1}, true).add({0.3, 0.3, -0.2}, {0.6, 0.6, 0.5}, false).mesh());

  EXPECT_FALSE(found.closed);
  EXPECT_EQ(found.open_share[6], 1);    // its bottom
  EXPECT_GT(found.open_share[8], 0.1);  // a side, partly below
  EXPECT_EQ(found.open_share[7], 0);    // its top
}

TEST(Enclosures, ASheetInTheRoomShowsItsBackUnlessItHasTwoSides) {
  Boxes room = Boxes().add({0, 0, 0}, {1, 1, 1}, true);
  const int first = static_cast<int>(room.vertices.size());
  for (const Vec3& x : {Vec3(0.3, 0.3, 0.5), Vec3(0.7, 0.3, 0.5), Vec3(0.7, 0.7, 0.6), Vec3(0.3, 0.7, 0.6)}) {
    room.vertices.push_back(x);
  }
  room.faces.push_back({first, first + 1, first + 2, first + 3});
  const Enclosures one_sided = enclosures_of(room.mesh());
  room.faces.push_back({first, first + 3, first + 2, first + 1});
  const Enclosures two_sided = enclosures_of(room.mesh());

  EXPECT_FALSE(one_sided.closed);
  EXPECT_GT(one_sided.back_share[0], 0.05);
  EXPECT_TRUE(two_sided.closed);
  EXPECT_EQ(two_sided.count, 1);
}

TEST(Enclosures, ARoomInsideAClosedBodyIsAnotherEnclosure) {
  // a hall, in it a body, in that a room of its own
  const Enclosures found = enclosures_of(Boxes()
                                             .add({0, 0, 0}, {3, 3, 3}, true)
                                             .add({1, 1, 1}, {2, 2, 2}, false)
                                             .add({1.2, 1.2, 1.2}, {1.8, 1.8, 1.8}, true)
                                             .mesh());

  EXPECT_TRUE(found.closed);
  EXPECT_EQ(found.count, 2);
  for (int i = 0; i < 12; ++i) EXPECT_EQ(found.enclosure[i], 0);
  for (int i = 12; i < 18; ++i) EXPECT_EQ(found.enclosure[i], 1);
}

TEST(Enclosures, FacesThatShareNoVertexStillClose) {
  // every face with corners of its own, as a file without welding has them
  const Boxes box = Boxes().add({0, 0, 0}, {1, 1, 1}, true);
  Boxes apart;
  for (const auto& face : box.faces) {
    const int first = static_cast<int>(apart.vertices.size());
    for (int corner : face) apart.vertices.push_back(box.vertices[corner]);
    apart.faces.push_back({first, first + 1, first + 2, first + 3});
  }
  const Enclosures found = enclosures_of(apart.mesh());

  EXPECT_TRUE(found.closed);
  EXPECT_EQ(found.count, 1);
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
