#include "triangulate.h"

#include <cmath>

namespace luxel {

namespace {

// Relative difference of area that rounding can explain; crossing borders make more.
constexpr double area_tolerance = 1e-6;

// Sine of a turn below which a corner counts as straight.
constexpr double straight_turn = 1e-9;

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

/// A lone convex quad, cut along its shorter diagonal: most polygons of a curved surface are.
std::optional<std::vector<std::array<int, 3>>> triangulate_quad(const PlanarDomain& domain) {
  if (domain.borders.size() != 4 || domain.points.size() != 4 || !domain.creases.empty()) return std::nullopt;
  std::array<int, 4> after = {-1, -1, -1, -1};
  for (const auto& [a, b] : domain.borders) after[a] = b;
  std::array<int, 4> loop = {0, 0, 0, 0};
  for (int k = 1; k < 4; ++k) {
    if (loop[k - 1] < 0) return std::nullopt;
    loop[k] = after[loop[k - 1]];
  }
  for (int k = 0; k < 4; ++k) {
    if (loop[k] < 0 || (k > 0 && loop[k] == 0)) return std::nullopt;
    const Vec2& p = domain.points[loop[k]];
    const Vec2& q = domain.points[loop[(k + 1) % 4]];
    const Vec2& r = domain.points[loop[(k + 2) % 4]];
    if (cross(q - p, r - q) <= straight_turn * (q - p).norm() * (r - q).norm()) return std::nullopt;
  }
  const auto diagonal = [&](int k) {
    return (domain.points[loop[k + 2]] - domain.points[loop[k]]).squaredNorm();
  };
  const int k = diagonal(0) <= diagonal(1) ? 0 : 1;
  return {{{loop[k], loop[k + 1], loop[k + 2]}, {loop[k], loop[k + 2], loop[(k + 3) % 4]}}};
}

}  // namespace

std::optional<std::vector<std::array<int, 3>>> triangulate(const PlanarDomain& domain) {
  if (domain.borders.size() < 3) return {};
  if (domain.borders.size() == 3 && domain.points.size() == 3) {
    const auto [a, b] = domain.borders[0];
    return {{{a, b, 3 - a - b}}};
  }
  if (auto pair = triangulate_quad(domain)) return pair;
#ifdef LUXEL_WITH_CGAL
  std::optional<std::vector<std::array<int, 3>>> triangles = triangulate_delaunay(domain);
#else
  std::optional<std::vector<std::array<int, 3>>> triangles = triangulate_by_ears(domain);
#endif
  if (!triangles || !cover(domain, *triangles)) return std::nullopt;
  return triangles;
}

}  // namespace luxel
