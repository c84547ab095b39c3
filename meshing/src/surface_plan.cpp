#include "surface_plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "angle.h"
#include "imprint.h"

namespace luxel {

namespace {

#ifdef LUXEL_WITH_CGAL
constexpr bool can_fill = true;
#else
constexpr bool can_fill = false;  // a lattice needs a Delaunay triangulation
#endif

// Triangles of curved surfaces are filled from this many edge lengths on: below, halving gives the same
// angles faster.
constexpr double filled_from = 3;

// Cosine between the normals of facets that lie in one plane (0.26 degrees).
constexpr double same_direction = 1 - 1e-5;

/// Finds the regions that are single triangles of a curved surface.
class CurvedTest {
 public:
  CurvedTest(const Facets& facets, const EdgeTable& edges, const MergedPolygons& merged, double longest,
             double crease_angle)
      : facets_(facets),
        edges_(edges),
        merged_(merged),
        longest_(longest),
        smooth_(std::cos(crease_angle / degrees_per_radian)) {}

  bool is_curved(int p) const {
    if (!is_single_triangle(p)) return false;
    const int facet = merged_.regions[p][0];
    const Vec3 normal = merged_.areas[facet].normalized();
    for (int h = facets_.loops.offsets[facet]; h < facets_.loops.offsets[facet + 1]; ++h) {
      const Vec3 edge = facets_.vertices[edges_.to(h)] - facets_.vertices[edges_.from(h)];
      if (edge.norm() > longest_) return false;
    }
    for (int h = facets_.loops.offsets[facet]; h < facets_.loops.offsets[facet + 1]; ++h) {
      for (const int g : edges_.uses(h)) {
        if (edges_.from(g) == edges_.from(h)) continue;
        const int other = edges_.loop(g);
        const double cosine = normal.dot(merged_.areas[other].normalized());
        if (cosine >= smooth_ && cosine < same_direction &&
            is_single_triangle(merged_.regions.region_of_facet[other])) {
          return true;
        }
      }
    }
    return false;
  }

 private:
  bool is_single_triangle(int p) const {
    return merged_.regions[p].size() == 1 && merged_.polygons.border(p).size() == 3 &&
           facets_.loop(merged_.regions[p][0]).size() == 3;
  }

  const Facets& facets_;
  const EdgeTable& edges_;
  const MergedPolygons& merged_;
  double longest_, smooth_;
};

}  // namespace

SurfacePlan plan_surface(const Scene& scene, const Facets& facets, const EdgeTable& edges, double edge_length,
                         double crease_angle) {
  const auto may_join = [&](int i, int j) {
    const int a = facets.faces[i];
    const int b = facets.faces[j];
    return scene.face_finishes[a] == scene.face_finishes[b] &&
           scene.face_materials[a] == scene.face_materials[b] &&
           scene.face_groups[a] == scene.face_groups[b] && facets.front[i] == facets.front[j] &&
           facets.back[i] == facets.back[j];
  };
  SurfacePlan plan{merge_facets(facets, edges, may_join), {}, {}, {}, {}, {}, {}, {}, 0};
  const MergedPolygons& merged = plan.merged;
  const CurvedTest curved(facets, edges, merged, filled_from * edge_length, crease_angle);

  std::vector<int> order(merged.regions.size());
  std::iota(order.begin(), order.end(), 0);
  std::vector<int> first_face(merged.regions.size());
  for (const int p : order) {
    int first = merged.regions[p][0];
    for (const int facet : merged.regions[p]) first = std::min(first, facet);
    first_face[p] = first;
  }
  std::sort(order.begin(), order.end(), [&](int a, int b) { return first_face[a] < first_face[b]; });

  std::vector<char> fill(merged.regions.size(), false);
  for (const int p : order) {
    fill[p] = can_fill && !merged.polygons.irregular[p] && !curved.is_curved(p);
    if (fill[p]) {
      plan.filled.push_back(p);
      for (const auto& [a, b] : merged.polygons.border(p)) plan.edges.add(a, b);
    } else {
      for (const auto& triangle : merged.triangles[p]) {
        plan.halved.push_back(triangle);
        plan.polygon_of_halved.push_back(p);
      }
    }
  }
  plan.creases = find_contact_edges(facets.vertices, merged, fill);
  for (const auto& list : plan.creases) {
    plan.contact_edges += static_cast<int>(list.size());
    for (const auto& [a, b] : list) plan.edges.add(a, b);
  }
  std::vector<std::vector<int>> edges_of;
  for (const int p : plan.filled) {
    std::vector<int>& list = edges_of.emplace_back();
    for (const auto& [a, b] : merged.polygons.border(p)) list.push_back(plan.edges.find(a, b));
    for (const auto& [a, b] : plan.creases[p]) list.push_back(plan.edges.find(a, b));
  }
  plan.turns = take_turns(plan.filled, edges_of, merged.regions.size(), plan.edges.size());
  for (const auto& triangle : plan.halved) {
    for (int k = 0; k < 3; ++k) {
      const std::array<int, 2> edge = {triangle[k], triangle[(k + 1) % 3]};
      if (plan.edges.find(edge[0], edge[1]) >= 0) plan.watched.push_back(edge);
    }
  }
  return plan;
}

}  // namespace luxel
