// CGAL's triangulations are GPL-3.0-or-later: this file stands alone in its object library, which also keeps
// CGAL's -frounding-math away from the rest.
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <unordered_set>

#include "triangulate.h"

namespace luxel {

namespace {

enum class Place : char { unknown, inside, outside };

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<Place, Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Delaunay = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>, CGAL::No_constraint_intersection_tag>;

std::uint64_t key(int a, int b) {
  return static_cast<std::uint64_t>(std::min(a, b)) << 32 | static_cast<std::uint32_t>(std::max(a, b));
}

/// Marks every face from the unbounded one inwards; the place changes across borders only, not across
/// creases.
void mark_places(Delaunay& delaunay, const std::unordered_set<std::uint64_t>& borders) {
  std::vector<Delaunay::Face_handle> stack = {delaunay.infinite_face()};
  stack.front()->info() = Place::outside;
  while (!stack.empty()) {
    const Delaunay::Face_handle face = stack.back();
    stack.pop_back();
    for (int k = 0; k < 3; ++k) {
      const Delaunay::Face_handle other = face->neighbor(k);
      if (other->info() != Place::unknown) continue;
      const bool border = face->is_constrained(k) && borders.contains(key(face->vertex((k + 1) % 3)->info(),
                                                                          face->vertex((k + 2) % 3)->info()));
      const bool inside = (face->info() == Place::inside) != border;
      other->info() = inside ? Place::inside : Place::outside;
      stack.push_back(other);
    }
  }
}

}  // namespace

std::optional<std::vector<std::array<int, 3>>> triangulate_delaunay(const PlanarDomain& domain) {
  Delaunay delaunay;
  std::vector<Delaunay::Vertex_handle> handles;
  handles.reserve(domain.points.size());
  Delaunay::Face_handle hint;
  for (std::size_t i = 0; i < domain.points.size(); ++i) {
    const auto vertex = delaunay.insert({domain.points[i].x(), domain.points[i].y()}, hint);
    hint = vertex->face();
    vertex->info() = static_cast<int>(i);
    handles.push_back(vertex);
  }
  if (delaunay.number_of_vertices() != domain.points.size() || delaunay.dimension() < 2) return {};
  std::unordered_set<std::uint64_t> borders;
  try {
    for (const auto& [a, b] : domain.borders) {
      delaunay.insert_constraint(handles[a], handles[b]);
      borders.insert(key(a, b));
    }
    for (const auto& [a, b] : domain.creases) delaunay.insert_constraint(handles[a], handles[b]);
  } catch (const Delaunay::Intersection_of_constraints_exception&) {
    return {};
  }
  for (auto face = delaunay.all_faces_begin(); face != delaunay.all_faces_end(); ++face) {
    face->info() = Place::unknown;
  }
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
