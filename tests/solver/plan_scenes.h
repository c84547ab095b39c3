#pragma once

#include <algorithm>
#include <vector>

#include "luxel/plan.h"
#include "solver/blocked_scenes.h"
#include "solver/hand_made_mesh.h"

namespace luxel::testing {

/// Gives every patch the reflectance, and no emission.
inline void paint(PatchMesh& mesh, const Rgb& reflectance) {
  mesh.finish_table = {{.reflectance = reflectance}};
  std::fill(mesh.finishes.begin(), mesh.finishes.end(), 0);
}

/// Another finish for the patches [begin, end).
inline void paint(PatchMesh& mesh, int begin, int end, const Rgb& reflectance, const Rgb& emission) {
  const int number = static_cast<int>(mesh.finish_table.size());
  mesh.finish_table.push_back({.reflectance = reflectance, .emission = emission});
  std::fill(mesh.finishes.begin() + begin, mesh.finishes.begin() + end, number);
}

/// Unit rooms in a row, a tenth apart, k x k patches a side: 6 k^2 patches each, in the order of the rooms.
inline PatchMesh rooms_in_a_row(int count, int k, const Rgb& reflectance) {
  SceneBuilder scene;
  for (int room = 0; room < count; ++room) {
    scene.box({1.1 * room, 0, 0}, {1.1 * room + 1, 1, 1}, Eigen::Matrix3d::Identity(), k, true);
  }
  PatchMesh mesh = scene.take();
  paint(mesh, reflectance);
  return mesh;
}

/// A room with a block in it; the first patches are the floor's. Closed.
inline PatchMesh furnished_room(int k, const Rgb& reflectance) {
  PatchMesh mesh = room_with_box(k, k / 2);
  paint(mesh, reflectance);
  return mesh;
}

/// Two plates of one patch, front to front, one metre wide and this far apart. Open.
inline PatchMesh facing_plates(double distance, const Rgb& reflectance) {
  SceneBuilder scene;
  scene.quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, 1);
  scene.quad({0, 0, distance}, {0, 1, distance}, {1, 1, distance}, {1, 0, distance}, 1);
  PatchMesh mesh = scene.take();
  paint(mesh, reflectance);
  return mesh;
}

inline bool mentions(const Plan& plan, const std::string& words) {
  return std::any_of(plan.left_out.begin(), plan.left_out.end(), [&](const LeftOut& item) {
    return (item.what + ": " + item.why + ": " + item.saved).find(words) != std::string::npos;
  });
}

}  // namespace luxel::testing
