#include <gtest/gtest.h>

#include "solver/plan_scenes.h"

namespace luxel {
namespace {

using testing::Boxes;
using testing::mentions;
using testing::paint;

const Rgb white = Rgb::Constant(0.7), black = Rgb::Zero(), bright(3, 2, 1);

Plan plan_of(const PatchMesh& mesh, const PlanOptions& options = {}) {
  return make_plan(mesh, planned_enclosures(mesh, options), options);
}

/// Two unit rooms with a common wall that has a square hole of this side in its middle; 0: no hole.
PatchMesh rooms_with_a_hole(double side) {
  testing::SceneBuilder scene;
  const auto wall = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    scene.quad(a, b, c, d, 1);
  };
  for (const double x : {0.0, 1.0}) {
    wall({x, 0, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}, {x, 1, 0});
    wall({x, 0, 1}, {x, 1, 1}, {x + 1, 1, 1}, {x + 1, 0, 1});
    wall({x, 0, 0}, {x, 0, 1}, {x + 1, 0, 1}, {x + 1, 0, 0});
    wall({x, 1, 0}, {x + 1, 1, 0}, {x + 1, 1, 1}, {x, 1, 1});
  }
  wall({0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1});
  wall({2, 0, 0}, {2, 0, 1}, {2, 1, 1}, {2, 1, 0});
  const auto both = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    scene.quad(a, b, c, d, 1, 2);
  };
  const double low = 0.5 - side / 2, high = 0.5 + side / 2;
  const Vec3 a(1, 0, 0), b(1, 1, 0), c(1, 1, 1), d(1, 0, 1);
  if (side == 0) {
    both(a, b, c, d);
  } else {
    const Vec3 p(1, low, low), q(1, high, low), r(1, high, high), s(1, low, high);
    both(a, b, q, p);
    both(b, c, r, q);
    both(c, d, s, r);
    both(d, a, p, s);
  }
  PatchMesh mesh = scene.take();
  paint(mesh, white);
  return mesh;
}

TEST(MakePlan, TakesOnlyTheRoomWithTheLamp) {
  PatchMesh mesh = testing::rooms_in_a_row(7, 1, white);
  paint(mesh, 12, 13, white, bright);

  const Plan plan = plan_of(mesh);

  ASSERT_EQ(plan.systems.size(), 1u);
  EXPECT_EQ(plan.systems[0].patches, (std::vector<int>{12, 13, 14, 15, 16, 17}));
  EXPECT_TRUE(mentions(plan, "6 enclosures of 36 patches"));
}

TEST(MakePlan, MakesEachLitRoomASystem) {
  PatchMesh mesh = testing::rooms_in_a_row(3, 1, white);
  paint(mesh, 0, 1, white, bright);
  paint(mesh, 12, 13, white, bright);

  const Plan plan = plan_of(mesh);

  ASSERT_EQ(plan.systems.size(), 2u);
  EXPECT_EQ(plan.systems[1].patches.front(), 12);
  EXPECT_TRUE(mentions(plan, "36 of 66 pairs"));  // 12 x 11 / 2 less two rooms of 6 x 5 / 2
}

TEST(MakePlan, PutsLitRoomsTogetherWhereWholeFieldsAreWanted) {
  PatchMesh mesh = testing::rooms_in_a_row(3, 1, white);
  paint(mesh, 0, 1, white, bright);
  paint(mesh, 12, 13, white, bright);
  PlanOptions options;
  options.together = true;

  const Plan plan = plan_of(mesh, options);

  ASSERT_EQ(plan.systems.size(), 1u);
  EXPECT_EQ(plan.systems[0].patches.size(), 12u);
}

TEST(MakePlan, PartsRoomsThatOnlyAWallOfNoThicknessParts) {
  PatchMesh mesh = rooms_with_a_hole(0);
  paint(mesh, 0, 1, white, bright);

  const Plan plan = plan_of(mesh);

  ASSERT_EQ(plan.systems.size(), 1u);
  EXPECT_EQ(plan.systems[0].patches.size(), 6u);
}

TEST(MakePlan, KeepsRoomsTogetherThatAHoleOfAMillionthJoins) {
  // 1e-6 of the diagonal, which is what enclosures promise to find
  PatchMesh mesh = rooms_with_a_hole(1e-6 * std::sqrt(6.0));
  paint(mesh, 0, 1, white, bright);

  const Plan plan = plan_of(mesh);

  ASSERT_EQ(plan.systems.size(), 1u);
  EXPECT_EQ(static_cast<int>(plan.systems[0].patches.size()), mesh.size());
  EXPECT_GT(plan.systems[0].hiding_polygons, 0);
}

TEST(MakePlan, KeepsPlatesTogetherThatNoRayConnects) {
  // F = 3e-7: none of 256 rays from either finds the other
  PatchMesh mesh = testing::facing_plates(1000, white);
  paint(mesh, 0, 1, white, bright);
  ASSERT_EQ(planned_enclosures(mesh).count, 2);

  const Plan plan = plan_of(mesh);

  ASSERT_EQ(plan.systems.size(), 1u);
  EXPECT_EQ(plan.systems[0].patches.size(), 2u);
}

TEST(MakePlan, LeavesPatchesAloneThatSeeNoOther) {
  PatchMesh mesh = Boxes().add({0, 0, 0}, {1, 1, 1}, false).mesh();
  paint(mesh, white);
  paint(mesh, 0, 2, white, bright);

  const Plan plan = plan_of(mesh);

  EXPECT_TRUE(plan.systems.empty());
  EXPECT_TRUE(mentions(plan, "2 patches: they see no other"));
}

TEST(MakePlan, HasNothingToSolveWhereNothingEmits) {
  EXPECT_TRUE(plan_of(testing::furnished_room(2, white)).systems.empty());
}

TEST(MakePlan, SolvesALampHoweverFaint) {
  PatchMesh mesh = testing::rooms_in_a_row(2, 1, white);
  paint(mesh, 7, 8, white, Rgb(0, 1e-300, 0));

  EXPECT_EQ(plan_of(mesh).systems.size(), 1u);
}

TEST(MakePlan, KeepsADarkRoomThatAbsorbsNothing) {
  PatchMesh mesh = testing::rooms_in_a_row(2, 1, white);
  paint(mesh, 0, 1, white, bright);
  paint(mesh, 6, 12, Rgb(0.5, 1, 0.5), black);

  EXPECT_EQ(plan_of(mesh).systems.size(), 2u);
}

TEST(MakePlan, CastsNoRayInABoxAndSomeWithABlockInIt) {
  PatchMesh box = testing::rooms_in_a_row(1, 2, white), furnished = testing::furnished_room(4, white);
  paint(box, 0, 1, white, bright);
  paint(furnished, 0, 1, white, bright);

  const Plan of_box = plan_of(box), of_furnished = plan_of(furnished);

  EXPECT_EQ(of_box.systems.at(0).hiding_polygons, 0);
  EXPECT_TRUE(mentions(of_box, "every ray"));
  EXPECT_EQ(of_furnished.systems.at(0).hiding_polygons, 6);
  EXPECT_TRUE(mentions(of_furnished, "6 of 12 polygons"));
  EXPECT_FALSE(mentions(of_furnished, "every ray"));
}

TEST(MakePlan, CountsBlackPatchesButNotThoseThatReflectATrillionth) {
  PatchMesh mesh = testing::rooms_in_a_row(1, 1, white);
  paint(mesh, 0, 2, black, bright);
  paint(mesh, 2, 3, Rgb::Constant(1e-12), black);

  EXPECT_TRUE(mentions(plan_of(mesh), "2 patches as unknowns"));
}

TEST(MakePlan, LeavesNothingOutWhereEverySavingIsOff) {
  PatchMesh mesh = testing::rooms_in_a_row(3, 1, white);
  paint(mesh, 0, 1, black, bright);
  PlanOptions options;
  options.savings = Savings::none();

  const Plan plan = plan_of(mesh, options);

  ASSERT_EQ(plan.systems.size(), 1u);
  EXPECT_EQ(plan.systems[0].patches.size(), 18u);
  EXPECT_EQ(plan.systems[0].channels.solved.size(), 3u);
  EXPECT_EQ(plan.systems[0].precision, Precision::float64);
  EXPECT_EQ(plan.systems[0].method, Method::cg);
  EXPECT_TRUE(plan.keep_idle_occluders);
  EXPECT_TRUE(plan.left_out.empty());
}

TEST(MakePlan, MakesFewSystemsOfThousandsOfCrumbs) {
  PatchMesh mesh = testing::rooms_in_a_row(700, 1, white);
  for (int room = 0; room < 700; ++room) paint(mesh, 6 * room, 6 * room + 1, white, bright);

  const Plan plan = plan_of(mesh);

  EXPECT_GE(plan.systems.size(), 32u);
  EXPECT_LE(plan.systems.size(), 130u);
  std::size_t patches = 0;
  for (const SystemPlan& system : plan.systems) patches += system.patches.size();
  EXPECT_EQ(patches, 4200u);
}

TEST(MakePlan, StoresFloatsOnlyWhereTheyAreAccurateEnoughAndSaveMemory) {
  EXPECT_EQ(storage_precision(10'000, 1e-3), Precision::float32);
  EXPECT_EQ(storage_precision(10'000, 1e-7), Precision::float64);
  EXPECT_EQ(storage_precision(1'000, 1e-3), Precision::float64);
}

TEST(MakePlan, RefusesEnclosuresOfAnotherMesh) {
  EXPECT_THROW(make_plan(testing::furnished_room(2, white), Enclosures()), std::invalid_argument);
}

}  // namespace
}  // namespace luxel
