#include "luxel/patch_mesh.h"

#include <numeric>

namespace luxel {

namespace {

PatchField finish_values(const PatchMesh& mesh, Rgb Finish::*value) {
  PatchField values(mesh.size(), 3);
  for (int i = 0; i < mesh.size(); ++i) values.row(i) = (mesh.finish_table[mesh.finishes[i]].*value).matrix();
  return values;
}

}  // namespace

PatchField emission(const PatchMesh& mesh) {
  return finish_values(mesh, &Finish::emission);
}

PatchField reflectance(const PatchMesh& mesh) {
  return finish_values(mesh, &Finish::reflectance);
}

double total_area(const PatchMesh& mesh) {
  return std::accumulate(mesh.areas.begin(), mesh.areas.end(), 0.0);
}

}  // namespace luxel
