#include "delaunay.h"

namespace luxel {

std::optional<std::vector<std::array<int, 3>>> triangulate_delaunay(const PlanarDomain& domain) {
  const std::unique_ptr<DomainTriangulation> triangulation = triangulate_domain(domain);
  if (!triangulation) return {};
  Delaunay& delaunay = triangulation->delaunay;
  std::unordered_set<std::uint64_t> borders;
  for (const auto& [a, b] : domain.borders) borders.insert(edge_key(a, b));
  mark_places(delaunay, borders);
  std::vector<std::array<int, 3>> triangles;
  triangles.reserve(delaunay.number_of_faces());
  for (auto face = delaunay.finite_faces_begin(); face != delaunay.finite_faces_end(); ++face) {
    if (face->info() != Place::inside) continue;
    triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
  }
  return triangles;
}

}  // namespace luxel
