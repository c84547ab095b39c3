#pragma once

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <memory>
#include <unordered_set>

#include "edge_key.h"
#include "triangulate.h"

namespace luxel {

enum class Place : char { unknown, inside, outside };

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<Place, Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Delaunay = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>, CGAL::No_constraint_intersection_tag>;

/// The domain's constrained Delaunay triangulation and its vertices in the domain's order, whose places there
/// they carry; nothing if borders or creases cross or points coincide.
struct DomainTriangulation {
  Delaunay delaunay;
  std::vector<Delaunay::Vertex_handle> vertices;
};
std::unique_ptr<DomainTriangulation> triangulate_domain(const PlanarDomain& domain);

/// Marks every face as inside or outside; `borders` are the keys of all border edges.
void mark_places(Delaunay& delaunay, const std::unordered_set<std::uint64_t>& borders);

}  // namespace luxel
