#pragma once

#include <array>

#include "polygon.h"
#include "regions.h"

namespace luxel {

/// A plane with axes: (u, v, n) is right-handed.
struct Frame {
  Vec3 origin, u, v, n;

  Vec2 flat(const Vec3& p) const { return {(p - origin).dot(u), (p - origin).dot(v)}; }
  Vec3 lift(const Vec2& p) const { return origin + p.x() * u + p.y() * v; }
  double height(const Vec3& p) const { return (p - origin).dot(n); }
};

/// Regions as polygons with holes. A vertex on a border is left out only if it is straight in every polygon
/// that it touches, so that polygons that met before still meet.
struct FlatPolygons {
  std::vector<Frame> frames;                 ///< the area-weighted plane
  std::vector<int> segment_offsets{0};       ///< polygon p has the segments [p] .. [p + 1]
  std::vector<std::array<int, 2>> segments;  ///< from corner to corner, the inside on the left
  std::vector<char> irregular;               ///< whose border is no set of simple loops, or was declared so

  int size() const { return static_cast<int>(frames.size()); }
  std::span<const std::array<int, 2>> border(int p) const {
    return std::span(segments).subspan(segment_offsets[p], segment_offsets[p + 1] - segment_offsets[p]);
  }
};

/// Polygon p is region p. All vertices on the borders of irregular polygons stay; further ones are added
/// where the border is not simple. Cost: linear.
FlatPolygons make_flat_polygons(const Facets& facets, const std::vector<Vec3>& areas, const EdgeTable& edges,
                                const Regions& regions, std::vector<char> irregular = {});

/// Area vectors of all facets.
std::vector<Vec3> facet_areas(const Facets& facets);

}  // namespace luxel
