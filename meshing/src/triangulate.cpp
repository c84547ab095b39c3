#include "triangulate.h"

#include <cmath>

namespace luxel {

namespace {

// Relative difference of area that rounding can explain; crossing borders make more.
constexpr double area_tolerance = 1e-6;

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Whether the triangles have the domain's area and none is turned over.
bool cover(const PlanarDomain& domain, const std::vector<std::array<int, 3>>& triangles) {
  const Vec2& origin = domain.points[domain.borders[0][0]];
  double expected = 0;
  for (const auto& [a, b] : domain.borders) {
    expected += cross(domain.points[a] - origin, domain.points[b] - origin);
  }
  double found = 0;
  for (const auto& [a, b, c] : triangles) {
    found += std::abs(cross(domain.points[b] - domain.points[a], domain.points[c] - domain.points[a]));
  }
  return std::abs(found - expected) <= area_tolerance * expected;
}

}  // namespace

std::optional<std::vector<std::array<int, 3>>> triangulate(const PlanarDomain& domain) {
  if (domain.borders.size() < 3) return {};
  if (domain.borders.size() == 3 && domain.points.size() == 3) {
    const auto [a, b] = domain.borders[0];
    return {{{a, b, 3 - a - b}}};
  }
#ifdef LUXEL_WITH_CGAL
  auto triangles = triangulate_delaunay(domain);
#else
  auto triangles = triangulate_by_ears(domain);
#endif
  if (triangles && !cover(domain, *triangles)) triangles.reset();
  return triangles;
}

}  // namespace luxel
