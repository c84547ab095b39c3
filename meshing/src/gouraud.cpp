#include "luxel/gouraud.h"

#include <stdexcept>

#include "smooth_fans.h"
#include "vertex_corners.h"

namespace luxel {

namespace {

void append(GouraudMesh& gouraud, const PatchMesh& mesh, std::span<const int> patches,
            const SmoothFans& fans) {
  const int offset = static_cast<int>(gouraud.vertices.size());
  for (const int v : fans.vertices) gouraud.vertices.push_back(mesh.vertices[v]);
  gouraud.normals.insert(gouraud.normals.end(), fans.normals.begin(), fans.normals.end());
  for (std::size_t i = 0; i < patches.size(); ++i) {
    auto& row = gouraud.corners[patches[i]];
    for (int k = 0; k < count_corners(row); ++k) row[k] = offset + fans.corners[i][k];
  }
}

}  // namespace

GouraudMesh gouraud_mesh(const PatchMesh& mesh, double crease_angle) {
  if (!(crease_angle > 0 && crease_angle <= 180)) {
    throw std::invalid_argument("crease_angle must be in (0, 180] degrees");
  }
  Loops loops;
  for (const auto& row : mesh.corners) {
    loops.append(std::span(row).first(static_cast<std::size_t>(count_corners(row))));
  }
  const ManifoldParts parts =
      find_manifold_parts(loops, EdgeTable(loops, static_cast<int>(mesh.vertices.size())));
  std::vector<int> manifold, others;
  for (int i = 0; i < mesh.size(); ++i) (parts.manifold[i] ? manifold : others).push_back(i);

  GouraudMesh gouraud;
  gouraud.corners = mesh.corners;
  append(gouraud, mesh, manifold, find_fans_on_half_edges(mesh, manifold, parts, loops, crease_angle));
  append(gouraud, mesh, others, find_fans_by_index(mesh, others, crease_angle));
  return gouraud;
}

}  // namespace luxel
