#include "polygon_fill.h"

#include <algorithm>
#include <unordered_set>

#include "triangulate.h"

namespace luxel {

void PolygonFiller::divide(const Frame& frame, int a, int b, const Sizing& sizing,
                           std::vector<Part>& parts) const {
  const Vec2 start = frame.flat(corners_[a]);
  const Vec2 d = frame.flat(corners_[b]) - start;
  const int count = sizing.parts(d.norm(), plan_.turns.of_edge[plan_.edges.find(a, b)]);
  // Parts end where the next ones start, to the last bit: the lattice counts how often its rows cross them.
  Vec2 from = start;
  for (int k = 1; k <= count; ++k) {
    const Vec2 to = k < count ? start + d * (static_cast<double>(k) / count) : frame.flat(corners_[b]);
    parts.push_back({from, to});
    from = to;
  }
}

PolygonFiller::Part PolygonFiller::longest_side(int p) const {
  const Frame& frame = plan_.merged.polygons.frames[p];
  Part longest = {Vec2::Zero(), Vec2::Zero()};
  for (const auto& [a, b] : plan_.merged.polygons.border(p)) {
    const Part side = {frame.flat(corners_[a]), frame.flat(corners_[b])};
    if ((side[1] - side[0]).squaredNorm() > (longest[1] - longest[0]).squaredNorm()) longest = side;
  }
  return longest;
}

double PolygonFiller::count(int p, const Sizing& sizing) const {
  const Frame& frame = plan_.merged.polygons.frames[p];
  const auto border = plan_.merged.polygons.border(p);
  std::vector<Part> border_parts, crease_parts;
  std::unordered_set<int> on_border, inside;
  for (const auto& [a, b] : border) {
    divide(frame, a, b, sizing, border_parts);
    on_border.insert(a);
  }
  for (const auto& [a, b] : plan_.creases[p]) {
    divide(frame, a, b, sizing, crease_parts);
    for (const int v : {a, b}) {
      if (!on_border.contains(v)) inside.insert(v);
    }
  }
  const HexagonalLattice lattice(border_parts, crease_parts, longest_side(p),
                                 sizing.at(plan_.turns.of_polygon[p]));
  // Euler: T = 2 V - E_border - 2 chi, with chi of the polygon from its coarsest triangulation.
  const double twice_chi = 2.0 * static_cast<double>(on_border.size()) - static_cast<double>(border.size()) -
                           static_cast<double>(plan_.merged.triangles[p].size());
  const double added_on_border = static_cast<double>(border_parts.size() - border.size());
  const double added_inside =
      static_cast<double>(inside.size() + crease_parts.size() - plan_.creases[p].size());
  const double vertices =
      static_cast<double>(on_border.size() + lattice.size()) + added_on_border + added_inside;
  return 2 * vertices - static_cast<double>(border_parts.size()) - twice_chi;
}

PolygonDomain PolygonFiller::domain(int p, const std::vector<int>& inside,
                                    const std::vector<Vec3>& vertices) {
  const Frame& frame = plan_.merged.polygons.frames[p];
  place_.resize(vertices.size(), -1);
  PolygonDomain result;
  PlanarDomain& domain = result.domain;
  const auto place = [&](int v) {
    if (place_[v] < 0) {
      place_[v] = static_cast<int>(result.vertices.size());
      result.vertices.push_back(v);
      domain.points.push_back(frame.flat(vertices[v]));
    }
    return place_[v];
  };
  const auto append = [&](int a, int b, std::vector<std::array<int, 2>>& list) {
    const std::vector<int> points = plan_.edges.points(a, b);
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
      const int from = place(points[k]);
      list.push_back({from, place(points[k + 1])});
      result.edges.push_back(plan_.edges.find(a, b));
    }
  };
  for (const auto& [a, b] : plan_.merged.polygons.border(p)) append(a, b, domain.borders);
  for (const auto& [a, b] : plan_.creases[p]) append(a, b, domain.creases);
  for (const int v : result.vertices) place_[v] = -1;
  for (const int v : inside) {
    result.vertices.push_back(v);
    domain.points.push_back(frame.flat(vertices[v]));
  }
  return result;
}

PolygonFill PolygonFiller::fill(int p, const Sizing& sizing, std::vector<Vec3>& vertices) {
  const PlanarDomain outline = domain(p, {}, vertices).domain;
  const auto parts = [&](const std::vector<std::array<int, 2>>& list) {
    std::vector<Part> result;
    result.reserve(list.size());
    for (const auto& [a, b] : list) result.push_back({outline.points[a], outline.points[b]});
    return result;
  };
  const HexagonalLattice lattice(parts(outline.borders), parts(outline.creases), longest_side(p),
                                 sizing.at(plan_.turns.of_polygon[p]));
  PolygonFill result{p, {}, {}};
  for (const Vec2& point : lattice.points()) {
    result.inside.push_back(static_cast<int>(vertices.size()));
    vertices.push_back(plan_.merged.polygons.frames[p].lift(point));
  }
  return refill(std::move(result), vertices);
}

PolygonFill PolygonFiller::refill(PolygonFill fill, const std::vector<Vec3>& vertices) {
  PolygonDomain local = domain(fill.polygon, fill.inside, vertices);
  std::optional<std::vector<std::array<int, 3>>> triangles = triangulate(local.domain);
  if (!triangles) {
    // Creases that meet at a very small angle can cross after rounding: the polygon is then filled without
    // them.
    local.domain.creases.clear();
    triangles = triangulate(local.domain);
  }
  if (!triangles) {
    fill.triangles = plan_.merged.triangles[fill.polygon];
    return fill;
  }
  for (auto& triangle : *triangles) {
    for (int& corner : triangle) corner = local.vertices[corner];
  }
  fill.triangles = *std::move(triangles);
  return fill;
}

}  // namespace luxel
