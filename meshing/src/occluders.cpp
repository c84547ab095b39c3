#include "occluders.h"

#include <algorithm>

#include "flat_polygons.h"
#include "polygon.h"
#include "triangulate.h"

namespace luxel {

namespace {

using Triangles = std::vector<std::array<int, 3>>;

/// Triangles of the facets of one region, over the facets' vertices.
Triangles facet_triangles(const Facets& facets, std::span<const int> members) {
  Triangles triangles;
  for (const int facet : members) {
    const auto loop = facets.loop(facet);
    for (const auto& [a, b, c] : triangulate_loop(facets.points(facet))) {
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

/// The same polygons from whichever side: each border as its sorted, undirected segments.
RepeatedLoops find_coincident(const FlatPolygons& polygons) {
  Loops keys;
  std::vector<std::array<int, 2>> segments;
  std::vector<int> key;
  for (int p = 0; p < polygons.size(); ++p) {
    segments.clear();
    for (const auto& [a, b] : polygons.border(p)) segments.push_back({std::min(a, b), std::max(a, b)});
    std::sort(segments.begin(), segments.end());
    key.clear();
    for (const auto& segment : segments) key.insert(key.end(), segment.begin(), segment.end());
    keys.append(key);
  }
  return find_repeated(keys);
}

struct TriangulatedPolygons {
  FlatPolygons polygons;
  std::vector<Triangles> triangles;  ///< empty for single triangles, which are their own
};

/// Merges, triangulates, and where a border cannot be triangulated falls back to the facets of that region,
/// whose vertices its neighbours then keep too.
TriangulatedPolygons triangulate_regions(const Facets& facets, const Regions& regions, const EdgeTable& edges,
                                         const std::vector<Vec3>& areas) {
  PolygonTriangulator triangulator(facets);
  std::vector<char> irregular;
  for (;;) {
    TriangulatedPolygons result;
    result.polygons = make_flat_polygons(facets, areas, edges, regions, irregular);
    result.triangles.resize(regions.size());
    irregular = result.polygons.irregular;
    bool failed = false;
    for (int r = 0; r < regions.size(); ++r) {
      const auto members = regions[r];
      std::optional<Triangles> triangles;
      if (!irregular[r] && (members.size() > 1 || facets.loop(members[0]).size() > 4)) {
        triangles = triangulator.triangulate(result.polygons.frames[r], result.polygons.border(r));
        if (!triangles) irregular[r] = failed = true;
      }
      result.triangles[r] = triangles ? *std::move(triangles) : facet_triangles(facets, members);
    }
    if (!failed) return result;
  }
}

}  // namespace

FacetOccluders make_occluders(const Facets& facets) {
  const EdgeTable edges(facets.loops, static_cast<int>(facets.vertices.size()));
  const std::vector<Vec3> areas = facet_areas(facets);
  const Regions regions = grow_regions(facets, areas, edges, [](int, int) { return true; });
  const TriangulatedPolygons merged = triangulate_regions(facets, regions, edges, areas);
  const RepeatedLoops repeated = find_coincident(merged.polygons);

  FacetOccluders result;
  Occluders& occluders = result.occluders;
  std::vector<int> index(facets.vertices.size(), -1);
  std::vector<int> polygon_of_region;
  for (int r = 0; r < regions.size(); ++r) {
    if (repeated.first[r] != r) {
      polygon_of_region.push_back(polygon_of_region[repeated.first[r]]);
      continue;
    }
    for (const auto& triangle : merged.triangles[r]) {
      std::array<int, 3> corners;
      for (int k = 0; k < 3; ++k) {
        int& place = index[triangle[k]];
        if (place < 0) {
          place = static_cast<int>(occluders.vertices.size());
          occluders.vertices.push_back(facets.vertices[triangle[k]]);
        }
        corners[k] = place;
      }
      occluders.triangles.push_back(corners);
      occluders.polygons.push_back(occluders.polygon_count);
    }
    polygon_of_region.push_back(occluders.polygon_count++);
  }
  result.polygon_of_facet.reserve(facets.size());
  for (const int r : regions.region_of_facet) result.polygon_of_facet.push_back(polygon_of_region[r]);
  return result;
}

}  // namespace luxel
