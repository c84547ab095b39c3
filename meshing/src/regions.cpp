#include "regions.h"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "order_by_key.h"
#include "polygon.h"
#include "weld.h"

namespace luxel {

namespace {

// How far a corner may be off the plane, as a share of the scene's diagonal: above the rounding of
// seven-digit text and of float coordinates, ten times below the thinnest wall that must keep its two sheets.
constexpr double plane_distance = 1e-7;

// The same as a share of the seed's longest edge: small bodies keep their shape.
constexpr double plane_share_of_edge = 1e-3;

// Cosine of the angle between normals that one plane may have (0.26 degrees).
constexpr double same_direction = 1 - 1e-5;

}  // namespace

Regions grow_regions(const Facets& facets, const std::vector<Vec3>& areas, const EdgeTable& edges,
                     const std::function<bool(int, int)>& may_join) {
  const double size = diagonal(facets.vertices);
  const double noise = rounding(facets.vertices);
  std::vector<double> magnitudes;
  magnitudes.reserve(areas.size());
  for (const Vec3& area : areas) magnitudes.push_back(area.norm());
  // The bits of numbers >= 0 are in their order: turned over, the largest first.
  std::vector<std::uint64_t> keys;
  keys.reserve(magnitudes.size());
  for (const double magnitude : magnitudes) keys.push_back(~std::bit_cast<std::uint64_t>(magnitude));
  const std::vector<int> order = order_by_key(keys);

  Regions regions;
  regions.region_of_facet.assign(facets.size(), -1);
  regions.members.reserve(facets.size());
  for (const int seed : order) {
    if (regions.region_of_facet[seed] >= 0) continue;
    const int region = regions.size();
    const Vec3 normal = areas[seed] / magnitudes[seed];
    const Vec3 origin = facets.vertices[facets.loop(seed)[0]];
    double longest = 0;
    const auto loop = facets.loop(seed);
    for (std::size_t k = 0; k < loop.size(); ++k) {
      longest =
          std::max(longest, (facets.vertices[loop[k]] - facets.vertices[loop[(k + 1) % loop.size()]]).norm());
    }
    const double tolerance = std::max(noise, std::min(plane_distance * size, plane_share_of_edge * longest));
    const auto fits = [&](int facet) {
      if (areas[facet].dot(normal) < same_direction * magnitudes[facet]) return false;
      return std::ranges::all_of(facets.loop(facet), [&](int v) {
        return std::abs((facets.vertices[v] - origin).dot(normal)) <= tolerance;
      });
    };
    regions.region_of_facet[seed] = region;
    regions.members.push_back(seed);
    for (std::size_t next = regions.offsets.back(); next < regions.members.size(); ++next) {
      const int member = regions.members[next];
      for (int h = facets.loops.offsets[member]; h < facets.loops.offsets[member + 1]; ++h) {
        for (const int g : edges.uses(h)) {
          const int facet = edges.loop(g);
          if (regions.region_of_facet[facet] >= 0 || edges.from(g) == edges.from(h)) continue;
          if (!may_join(member, facet) || !fits(facet)) continue;
          regions.region_of_facet[facet] = region;
          regions.members.push_back(facet);
          break;
        }
      }
    }
    regions.offsets.push_back(static_cast<int>(regions.members.size()));
    regions.tolerances.push_back(tolerance);
  }
  return regions;
}

}  // namespace luxel
