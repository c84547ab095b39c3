// CGAL's triangulations are GPL-3.0-or-later: this folder is an object library of its own, which also keeps
// CGAL's -frounding-math away from the rest.
#include "delaunay.h"

namespace luxel {

std::unique_ptr<DomainTriangulation> triangulate_domain(const PlanarDomain& domain) {
  auto result = std::make_unique<DomainTriangulation>();
  auto& [delaunay, vertices] = *result;
  vertices.reserve(domain.points.size());
  Delaunay::Face_handle hint;
  for (std::size_t i = 0; i < domain.points.size(); ++i) {
    const auto vertex = delaunay.insert({domain.points[i].x(), domain.points[i].y()}, hint);
    hint = vertex->face();
    vertex->info() = static_cast<int>(i);
    vertices.push_back(vertex);
  }
  if (delaunay.number_of_vertices() != domain.points.size() || delaunay.dimension() < 2) return {};
  try {
    for (const auto& [a, b] : domain.borders) delaunay.insert_constraint(vertices[a], vertices[b]);
    for (const auto& [a, b] : domain.creases) delaunay.insert_constraint(vertices[a], vertices[b]);
  } catch (const Delaunay::Intersection_of_constraints_exception&) {
    return {};
  }
  return result;
}

// From the unbounded face inwards; the place changes across borders only, not across creases.
void mark_places(Delaunay& delaunay, const std::unordered_set<std::uint64_t>& borders) {
  for (auto face = delaunay.all_faces_begin(); face != delaunay.all_faces_end(); ++face) {
    face->info() = Place::unknown;
  }
  std::vector<Delaunay::Face_handle> stack = {delaunay.infinite_face()};
  stack.front()->info() = Place::outside;
  while (!stack.empty()) {
    const Delaunay::Face_handle face = stack.back();
    stack.pop_back();
    for (int k = 0; k < 3; ++k) {
      const Delaunay::Face_handle other = face->neighbor(k);
      if (other->info() != Place::unknown) continue;
      const bool border =
          face->is_constrained(k) &&
          borders.contains(edge_key(face->vertex((k + 1) % 3)->info(), face->vertex((k + 2) % 3)->info()));
      const bool inside = (face->info() == Place::inside) != border;
      other->info() = inside ? Place::inside : Place::outside;
      stack.push_back(other);
    }
  }
}

}  // namespace luxel
