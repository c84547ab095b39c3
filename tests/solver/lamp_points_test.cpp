#include "operator_error/lamp_points.h"

#include <gtest/gtest.h>

#include <vector>

#include "solver/gather_scenes.h"

namespace luxel {
namespace {

using namespace luxel::testing;

TEST(LampPoints, AreDrawnWithTheDensityThatTheyTell) {
  const PatchMesh mesh = cut_faces(room_with_a_box(), 4);
  PatchField emission = glow(mesh, {1}, 2);
  for (int i = 0; i < mesh.size(); ++i) {
    if (mesh.faces[i] == 6 && i % 3 == 0) emission(i, 0) = 7;
  }
  std::vector<int> order(mesh.size());
  for (int i = 0; i < mesh.size(); ++i) order[i] = i;
  const LampPoints lamps(mesh, emission, order, 0.5);
  const LampPoints::View view(lamps, 5);  // on the floor

  std::vector<double> drawn(mesh.size(), 0.0);
  constexpr int side = 400;
  for (int k = 0; k < side; ++k) {
    const LampPoints::Point point = view.point((k + 0.5) / side, 0.5);
    drawn[point.patch] += 1.0 / side;
    EXPECT_EQ(point.density, view.density(point.patch));
    EXPECT_NEAR(mesh.normals[point.patch].dot(point.at - mesh.centroids[point.patch]), 0, 1e-12);
  }

  double sum = 0;
  for (int i = 0; i < mesh.size(); ++i) {
    sum += view.density(i) * mesh.areas[i];
    // steps of 1 / side
    EXPECT_NEAR(drawn[i], view.density(i) * mesh.areas[i], 2.0 / side);
    if (emission(i, 0) == 0) {
      EXPECT_EQ(view.density(i), 0);
    }
  }
  EXPECT_NEAR(sum, 1, 1e-12);
}

}  // namespace
}  // namespace luxel
