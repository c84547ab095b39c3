#pragma once

#include <algorithm>
#include <cmath>

#include "luxel/dense_operator.h"
#include "luxel/enclosures.h"
#include "luxel/form_factors.h"
#include "luxel/hierarchical_operator.h"
#include "solver/blocked_scenes.h"
#include "solver/gather_scenes.h"

namespace luxel::testing {

inline Enclosures enclosures_of(const PatchMesh& mesh) {
  return find_enclosures(mesh, RayScene(mesh.occluders));
}

/// A closed room with two turned boxes and a lamp of its own finish in the ceiling.
struct LitRoom {
  PatchMesh mesh;
  PatchField reflectance, emission;
};

inline LitRoom lit_room(int walls, int sides) {
  LitRoom room{room_with_turned_boxes(walls, sides), {}, {}};
  PatchMesh& mesh = room.mesh;
  mesh.finish_table.resize(2);
  room.reflectance = PatchField::Constant(mesh.size(), 3, 0.7);
  room.emission = PatchField::Zero(mesh.size(), 3);
  for (int i = 0; i < mesh.size(); ++i) {
    const Vec3& x = mesh.centroids[i];
    if (x.z() < 0.999 || std::max(std::abs(x.x() - 0.5), std::abs(x.y() - 0.5)) > 0.2) continue;
    mesh.finishes[i] = 1;
    room.reflectance.row(i) << 0.5, 0.6, 0.4;
    room.emission.row(i) << 10, 8, 0;
  }
  return room;
}

/// With exact visibility, closed.
inline ClosedOperator dense_of(const PatchMesh& mesh, double accuracy = 5e-4) {
  FormFactorOptions options;
  options.accuracy = accuracy;
  return close_rows(form_factors(mesh, options).exchange_areas, mesh.areas, enclosures_of(mesh));
}

}  // namespace luxel::testing
