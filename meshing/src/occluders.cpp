#include "occluders.h"

#include <algorithm>

#include "merged_polygons.h"

namespace luxel {

namespace {

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

/// Overlaps of regions as pairs of different polygons, each once.
std::vector<std::array<int, 2>> name_polygons(const std::vector<OverlappingPair>& overlaps,
                                              const std::vector<int>& polygon_of_region) {
  std::vector<std::array<int, 2>> pairs;
  for (const OverlappingPair& overlap : overlaps) {
    const auto [a, b] = std::minmax(polygon_of_region[overlap.first], polygon_of_region[overlap.second]);
    if (a != b) pairs.push_back({a, b});
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

}  // namespace

FacetOccluders make_occluders(const Facets& facets, const EdgeTable& edges) {
  MergedPolygons merged = merge_facets(facets, edges, [](int, int) { return true; });
  const Regions& regions = merged.regions;
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
  result.overlaps = find_overlapping(facets.vertices, merged);
  occluders.coplanar = name_polygons(result.overlaps, polygon_of_region);
  if (!result.overlaps.empty()) result.regions = std::move(merged.regions);
  return result;
}

}  // namespace luxel
