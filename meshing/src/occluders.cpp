#include "occluders.h"

#include "polygon.h"
#include "repeated_loops.h"

namespace luxel {

FacetOccluders make_occluders(const Facets& facets) {
  FacetOccluders result;
  Occluders& occluders = result.occluders;
  const RepeatedLoops repeated = find_repeated({facets.offsets, facets.corners});
  std::vector<int> index(facets.vertices.size(), -1);
  for (int i = 0; i < facets.size(); ++i) {
    if (repeated.first[i] != i) {
      result.polygon_of_facet.push_back(result.polygon_of_facet[repeated.first[i]]);
      continue;
    }
    const std::span<const int> loop = facets.loop(i);
    for (const auto& triangle : triangulate_loop(facets.points(i))) {
      std::array<int, 3> corners;
      for (int k = 0; k < 3; ++k) {
        int& place = index[loop[triangle[k]]];
        if (place < 0) {
          place = static_cast<int>(occluders.vertices.size());
          occluders.vertices.push_back(facets.vertices[loop[triangle[k]]]);
        }
        corners[k] = place;
      }
      occluders.triangles.push_back(corners);
      occluders.polygons.push_back(occluders.polygon_count);
    }
    result.polygon_of_facet.push_back(occluders.polygon_count++);
  }
  return result;
}

}  // namespace luxel
