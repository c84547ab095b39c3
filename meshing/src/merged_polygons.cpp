#include "merged_polygons.h"

#include "corner_positions.h"
#include "polygon.h"
#include "triangulate.h"

namespace luxel {

namespace {

using Triangles = std::vector<std::array<int, 3>>;

/// Triangles of the facets of one region, over the facets' vertices.
Triangles facet_triangles(const Facets& facets, std::span<const int> members) {
  Triangles triangles;
  CornerPositions positions(facets.vertices);
  for (const int facet : members) {
    const auto loop = facets.loop(facet);
    for (const auto& [a, b, c] : triangulate_loop(positions(loop))) {
      triangles.push_back({loop[a], loop[b], loop[c]});
    }
  }
  return triangles;
}

/// Triangles of a polygon over the facets' vertices; nothing if its border crosses itself.
class PolygonTriangulator {
 public:
  explicit PolygonTriangulator(const Facets& facets) : facets_(facets), place_(facets.vertices.size(), -1) {}

  std::optional<Triangles> triangulate(const Frame& frame, std::span<const std::array<int, 2>> border) {
    PlanarDomain domain;
    std::vector<int> vertices;
    for (const auto& segment : border) {
      for (const int v : segment) {
        if (place_[v] >= 0) continue;
        place_[v] = static_cast<int>(vertices.size());
        vertices.push_back(v);
        domain.points.push_back(frame.flat(facets_.vertices[v]));
      }
      domain.borders.push_back({place_[segment[0]], place_[segment[1]]});
    }
    std::optional<Triangles> triangles = luxel::triangulate(domain);
    if (triangles) {
      for (auto& triangle : *triangles) {
        for (int& corner : triangle) corner = vertices[corner];
      }
    }
    for (const int v : vertices) place_[v] = -1;
    return triangles;
  }

 private:
  const Facets& facets_;
  std::vector<int> place_;  // of a vertex in the domain at hand
};

}  // namespace

MergedPolygons merge_facets(const Facets& facets, const EdgeTable& edges,
                            const std::function<bool(int, int)>& may_join) {
  MergedPolygons merged{facet_areas(facets), {}, {}, {}};
  merged.regions = grow_regions(facets, merged.areas, edges, may_join);
  PolygonTriangulator triangulator(facets);
  std::vector<char> irregular;
  for (bool settled = false; !settled;) {
    // What cannot be triangulated falls back to its facets, whose vertices its neighbours then keep too.
    settled = true;
    merged.polygons = make_flat_polygons(facets, merged.areas, edges, merged.regions, irregular);
    merged.triangles.assign(merged.regions.size(), {});
    irregular = merged.polygons.irregular;
    for (int p = 0; p < merged.regions.size(); ++p) {
      std::optional<Triangles> triangles;
      if (!irregular[p]) {
        triangles = triangulator.triangulate(merged.polygons.frames[p], merged.polygons.border(p));
        if (!triangles) {
          irregular[p] = true;
          settled = false;
        }
      }
      merged.triangles[p] = triangles ? *std::move(triangles) : facet_triangles(facets, merged.regions[p]);
    }
  }
  return merged;
}

}  // namespace luxel
