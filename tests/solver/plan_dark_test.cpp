#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "luxel/plan.h"
#include "plan/dark_enclosures.h"
#include "plan/with_dark.h"
#include "solver/gather_scenes.h"
#include "solver/plan_scenes.h"

namespace luxel {
namespace {

using namespace luxel::testing;

constexpr int cuts = 6;
constexpr int room_size = 6 * cuts * cuts;

// Three unit rooms in a row, a lamp on some patches of the one in the middle.
PatchMesh lamp_in_the_middle() {
  PatchMesh mesh = rooms_in_a_row(3, cuts, {0.7, 0.5, 0.3});
  paint(mesh, room_size, room_size + 6, {0.5, 0.5, 0.5}, {10, 8, 6});
  return mesh;
}

// The same room by itself, where it stands.
PatchMesh middle_alone() {
  std::vector<int> middle(room_size);
  std::iota(middle.begin(), middle.end(), room_size);
  return sub_mesh(lamp_in_the_middle(), middle, true);
}

PlanOptions accurate_to(double accuracy, bool dark = true) {
  PlanOptions options;
  options.form_factors.accuracy = accuracy;
  options.savings.dark_enclosures = dark;
  return options;
}

bool mentions(const std::vector<LeftOut>& list, const std::string& words) {
  return std::any_of(list.begin(), list.end(), [&](const LeftOut& item) {
    return (item.what + ": " + item.why + ": " + item.saved).find(words) != std::string::npos;
  });
}

// Exactly 0 outside the middle room, and there what it has by itself.
void expect_light_of_the_middle(const RadiositySolution& whole, const RadiositySolution& alone) {
  EXPECT_EQ(whole.irradiance.middleRows(room_size, room_size), alone.irradiance);
  EXPECT_EQ(whole.radiosity.middleRows(room_size, room_size), alone.radiosity);
  for (const PatchField* field : {&whole.irradiance, &whole.radiosity}) {
    ASSERT_EQ(field->rows(), 3 * room_size);
    EXPECT_EQ(field->topRows(room_size).cwiseAbs().maxCoeff(), 0);
    EXPECT_EQ(field->bottomRows(room_size).cwiseAbs().maxCoeff(), 0);
  }
}

DarkEnclosures dark_of(const PatchMesh& mesh) {
  return dark_enclosures(mesh, RayScene(mesh.occluders));
}

TEST(DarkEnclosures, AreThoseWithoutALamp) {
  const DarkEnclosures dark = dark_of(lamp_in_the_middle());

  EXPECT_EQ(dark.count, 2);
  EXPECT_EQ(dark.patches, 2 * room_size);
  EXPECT_TRUE(dark.others_closed);
  ASSERT_EQ(dark.others.size(), static_cast<std::size_t>(room_size));
  EXPECT_EQ(dark.others.front(), room_size);
  EXPECT_EQ(dark.enclosure.front(), 0);
  EXPECT_EQ(dark.enclosure.back(), 1);
}

TEST(DarkEnclosures, AreLitByALampThatFloatsInThem) {
  PatchMesh mesh = cut_faces(room_with_a_box().add({3, 0, 0}, {4, 1, 1}, true), 1);
  paint(mesh, {0.5, 0.5, 0.5});
  paint(mesh, 6, 7, {0.5, 0.5, 0.5}, {1, 1, 1});  // of the box

  const DarkEnclosures dark = dark_of(mesh);

  EXPECT_EQ(dark.count, 1);
  EXPECT_EQ(dark.others, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
}

TEST(DarkEnclosures, AreNotOpen) {
  Boxes boxes = Boxes().add({0, 0, 0}, {1, 1, 1}, true).add({3, 0, 0}, {4, 1, 1}, true);
  boxes.faces.pop_back();
  PatchMesh mesh = cut_faces(boxes, 2);
  paint(mesh, {0.5, 0.5, 0.5});
  paint(mesh, 0, 1, {0.5, 0.5, 0.5}, {1, 1, 1});

  EXPECT_EQ(dark_of(mesh).count, 0);
}

TEST(DarkEnclosures, AreKeptWhereNothingIsAbsorbed) {
  PatchMesh mesh = lamp_in_the_middle();
  paint(mesh, 0, room_size, {1, 0.5, 0.5}, {0, 0, 0});

  const DarkEnclosures dark = dark_of(mesh);

  EXPECT_EQ(dark.count, 1);
  EXPECT_EQ(dark.others.front(), 0);
}

TEST(DarkEnclosures, AreLitThroughAPatchThatReachesIntoThem) {
  // one ceiling over two rooms that share a wall: its polygon is one, and so may a patch be
  const std::vector<Vec3> vertices{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0},
                                   {0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {0, 1, 1}, {1, 1, 1}, {2, 1, 1}};
  const std::vector<std::array<int, 4>> faces{{0, 1, 4, 3},   {0, 6, 7, 1},  {3, 4, 10, 9}, {0, 3, 9, 6},
                                              {1, 7, 10, 4},  {6, 9, 10, 7}, {1, 2, 5, 4},  {1, 7, 8, 2},
                                              {4, 5, 11, 10}, {2, 8, 11, 5}, {1, 4, 10, 7}, {7, 10, 11, 8}};
  PatchMesh mesh = hand_made_mesh(vertices, faces);
  for (int i = 0; i < mesh.size(); ++i) {
    // normals to the inside
    const Vec3 middle(i < 6 ? 0.5 : 1.5, 0.5, 0.5);
    ASSERT_GT(mesh.normals[i].dot(middle - mesh.centroids[i]), 0) << i;
  }
  paint(mesh, {0.5, 0.5, 0.5});
  paint(mesh, 0, 1, {0.5, 0.5, 0.5}, {1, 1, 1});
  ASSERT_EQ(dark_of(mesh).count, 1);
  const int left = mesh.polygons[5], right = mesh.polygons[11];
  std::replace(mesh.occluders.polygons.begin(), mesh.occluders.polygons.end(), right, left);
  mesh.polygons[11] = left;

  EXPECT_EQ(dark_of(mesh).count, 0);
}

TEST(RunGathered, CastsNoRayFromTheDark) {
  PlanOptions options = accurate_to(0.03);
  options.error_bar = true;
  const GatheredRun alone = run_gathered(middle_alone(), options);

  const GatheredRun run = run_gathered(lamp_in_the_middle(), options);

  EXPECT_EQ(run.gather.rays, alone.gather.rays);
  EXPECT_EQ(run.gather.shadow_rays, alone.gather.shadow_rays);
  EXPECT_GT(run.gather.rays, 0);
  expect_light_of_the_middle(run.light.solution, alone.light.solution);
  EXPECT_EQ(run.light.energy.emitted, alone.light.energy.emitted);
  EXPECT_EQ(run.light.energy.imbalance, alone.light.energy.imbalance);
  EXPECT_EQ(run.light.operator_error->high, alone.light.operator_error->high);
  EXPECT_TRUE(mentions(run.left_out, "2 enclosures of 432 patches: nothing emits in them"));
  EXPECT_TRUE(mentions(run.left_out, "432 of 648 patches as senders and receivers"));
}

TEST(RunGathered, TellsTheDarkAsClosedEnclosures) {
  const GatheredRun run = run_gathered(lamp_in_the_middle(), accurate_to(0.05));

  EXPECT_TRUE(run.enclosures.closed);
  EXPECT_EQ(run.enclosures.count, 3);
  for (int i = 0; i < 3 * room_size; ++i) {
    ASSERT_EQ(run.enclosures.enclosure[i], i / room_size);
    ASSERT_EQ(run.enclosures.open_share[i], 0);
    const double sum = run.light.row_sums[i];
    if (i / room_size == 1) {
      ASSERT_EQ(sum, 1);
    } else {
      ASSERT_TRUE(std::isnan(sum));
    }
  }
}

TEST(RunGathered, WorksOnTheDarkWhereThatIsAskedFor) {
  const PatchMesh mesh = lamp_in_the_middle();
  const GatheredRun full = run_gathered(mesh, accurate_to(0.01, false));

  const GatheredRun run = run_gathered(mesh, accurate_to(0.01));

  EXPECT_EQ(full.gather.rays % (3 * room_size), 0);
  EXPECT_FALSE(mentions(full.left_out, "enclosure"));
  // two samples of the same light
  EXPECT_LT(relative_rms(mesh, run.light.solution.irradiance, full.light.solution.irradiance), 0.02);
}

TEST(RunGathered, TellsIterationsOfTheWholeMesh) {
  PlanOptions options = accurate_to(0.05);
  int told = 0;
  options.solve.on_iteration = [&](const Iteration& iteration) {
    ++told;
    EXPECT_EQ(iteration.radiosity->rows(), 3 * room_size);
    EXPECT_EQ(iteration.radiosity->topRows(room_size).maxCoeff(), 0);
    EXPECT_GT(iteration.radiosity->middleRows(room_size, room_size).maxCoeff(), 0);
    return true;
  };

  run_gathered(lamp_in_the_middle(), options);

  EXPECT_GT(told, 1);
}

TEST(RunGathered, NamesThePatchOfASingularRoomAmongAll) {
  PatchMesh mesh = lamp_in_the_middle();
  paint(mesh, room_size, 2 * room_size, {1, 1, 1}, {1, 1, 1});

  try {
    run_gathered(mesh, accurate_to(0.05));
    FAIL() << "a room that absorbs nothing was solved";
  } catch (const SingularSystem& singular) {
    EXPECT_EQ(singular.patch(), room_size);
  }
}

TEST(RunGathered, NeedsNothingWhereAllIsDark) {
  const GatheredRun run = run_gathered(rooms_in_a_row(2, 3, {0.5, 0.5, 0.5}), accurate_to(0.05));

  EXPECT_EQ(run.light.rays, 0);
  EXPECT_EQ(run.light.solution.irradiance, PatchField::Zero(108, 3));
  EXPECT_TRUE(run.light.solution.report.converged);
  EXPECT_EQ(run.enclosures.count, 2);
  EXPECT_TRUE(run.enclosures.closed);
}

TEST(RunHierarchical, MakesNoBlockOfTheDark) {
  PlanOptions options = accurate_to(0.03);
  options.error_bar = true;
  const HierarchicalRun alone = run_hierarchical(middle_alone(), options);

  const HierarchicalRun run = run_hierarchical(lamp_in_the_middle(), options);

  EXPECT_EQ(run.hierarchical.blocks, alone.hierarchical.blocks);
  EXPECT_EQ(run.hierarchical.entries, alone.hierarchical.entries);
  expect_light_of_the_middle(run.light.solution, alone.light.solution);
  EXPECT_EQ(run.light.operator_error->high, alone.light.operator_error->high);
  EXPECT_EQ(run.light.energy.absorbed, alone.light.energy.absorbed);
  EXPECT_TRUE(mentions(run.left_out, "432 of 648 patches as senders and receivers"));
  EXPECT_EQ(run.enclosures.count, 3);
  EXPECT_TRUE(run.enclosures.closed);
  EXPECT_FALSE(
      mentions(run_hierarchical(lamp_in_the_middle(), accurate_to(0.03, false)).left_out, "enclosure"));
}

TEST(RunHierarchical, NamesTheUnclosedPatchAmongAll) {
  const DarkEnclosures dark = dark_of(lamp_in_the_middle());
  PlannedSolution light = light_of_none();
  light.solution.radiosity = light.solution.irradiance = PatchField::Zero(room_size, 3);
  light.closure.unclosed = 5;

  add_dark(light, dark);

  EXPECT_EQ(light.closure.unclosed, room_size + 5);
  EXPECT_EQ(light.closure.message, unclosed_message(room_size + 5));
}

}  // namespace
}  // namespace luxel
