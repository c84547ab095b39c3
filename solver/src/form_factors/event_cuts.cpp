#include "form_factors/event_cuts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace luxel {

namespace {

// Cuts that take less than this share of the patch's length change nothing that a quadrature would see.
constexpr double thinnest_cut = 2e-4;

// Two planes are the same when the sine of their angle is below this: an occluder's edge that lies in the
// plane of the outer patch makes no event on it.
constexpr double same_plane = 1e-9;

// An event: `corner` is seen in line with a point of the edge p-q. `beyond`: the corner lies beyond the edge,
// else before it.
struct Event {
  Vec3 corner, p, q;
  bool beyond = false;
};

class Cutter {
 public:
  Cutter(const Polygon& cell, const Vec3& normal, double size, std::size_t max_cells)
      : whole_(cell), normal_(normal), size_(size), max_cells_(max_cells), cells_{cell} {}

  void cut(const Event& event) {
    if (cells_.size() >= max_cells_) return;
    const Vec3 to_p = event.p - event.corner, to_q = event.q - event.corner;
    Vec3 across = to_p.cross(to_q);
    // most planes pass by the cell: seen before any root is drawn
    Span span;
    for (int k = 0; k < whole_.count; ++k) {
      const double height = across.dot(whole_[k] - event.corner);
      span.low = std::min(span.low, height);
      span.high = std::max(span.high, height);
    }
    if (span.low >= 0 || span.high <= 0) return;
    const double length = across.norm();
    if (length < 1e-14) return;
    across /= length;
    span = {span.low / length, span.high / length};
    const Plane plane{across, across.dot(event.corner)};
    const double slant = across.cross(normal_).norm();
    if (slant < same_plane) return;
    const double tolerance = thinnest_cut * size_ * slant;
    if (span.low > -tolerance || span.high < tolerance) return;

    // most cells stay as they are, where they are
    const std::size_t before = cells_.size();
    for (std::size_t k = 0; k < before; ++k) {
      const Span within = span_along(cells_[k], plane);
      if (within.low > -tolerance || within.high < tolerance) continue;
      if (!happens(cells_[k], plane, event, to_p, to_q, across)) continue;
      const Halves parts = halves(cells_[k], plane, tolerance);
      if (parts.front.count == 0 || parts.behind.count == 0 || parts.front.count >= Polygon::capacity - 2 ||
          parts.behind.count >= Polygon::capacity - 2) {
        continue;
      }
      cells_[k] = parts.front;
      cells_.push_back(parts.behind);
    }
  }

  std::vector<Polygon> take() { return std::move(cells_); }

 private:
  // Whether somewhere on the cut through the cell the corner is seen between the ends of the edge.
  static bool happens(const Polygon& cell, const Plane& plane, const Event& event, const Vec3& to_p,
                      const Vec3& to_q, const Vec3& across) {
    double share_p = -1, share_q = -1;  // of the edge's ends, the larger at the cut's two ends
    for (int k = 0; k < cell.count; ++k) {
      const double here = plane.distance(cell[k]), there = plane.distance(cell.next(k));
      if (!((here >= 0 && there < 0) || (here < 0 && there >= 0))) continue;
      Vec3 sight = cell[k] + (here / (here - there)) * (cell.next(k) - cell[k]) - event.corner;
      if (!event.beyond) sight = -sight;
      const double scale = sight.norm() * to_p.norm() + 1e-300;
      share_p = std::max(share_p, across.dot(sight.cross(to_q)) / scale);
      share_q = std::max(share_q, across.dot(to_p.cross(sight)) / scale);
    }
    return share_p > same_plane && share_q > same_plane;
  }

  Polygon whole_;
  Vec3 normal_;
  double size_;
  std::size_t max_cells_;
  std::vector<Polygon> cells_;
};

bool same(const Vec3& a, const Vec3& b) {
  return (a - b).squaredNorm() < 1e-24;
}

// The ends of the cones' edges that no edge before has.
std::vector<Vec3> corners_of(const Shadows& shadows) {
  std::vector<Vec3> corners;
  for (const ShadowEdge& edge : shadows.edges) {
    for (const Vec3& end : {edge.p, edge.q}) {
      if (std::none_of(corners.begin(), corners.end(), [&](const Vec3& c) { return same(c, end); })) {
        corners.push_back(end);
      }
    }
  }
  return corners;
}

}  // namespace

Halves halves(const Polygon& polygon, const Plane& plane, double tolerance) {
  Halves parts;
  const Span span = span_along(polygon, plane);
  if (span.low > -tolerance) {
    parts.front = polygon;
    return parts;
  }
  if (span.high < tolerance) {
    parts.behind = polygon;
    return parts;
  }
  auto add = [](Polygon& part, const Vec3& corner) {
    if (part.count < Polygon::capacity) part.corners[part.count++] = corner;
  };
  for (int k = 0; k < polygon.count; ++k) {
    const double here = plane.distance(polygon[k]), there = plane.distance(polygon.next(k));
    if (here >= 0) add(parts.front, polygon[k]);
    if (here <= 0) add(parts.behind, polygon[k]);
    if ((here > 0 && there < 0) || (here < 0 && there > 0)) {
      const Vec3 crossing = polygon[k] + (here / (here - there)) * (polygon.next(k) - polygon[k]);
      add(parts.front, crossing);
      add(parts.behind, crossing);
    }
  }
  return parts;
}

std::vector<Polygon> cut_by_events(const Polygon& cell, const Vec3& normal, const Polygon& inner,
                                   const Shadows& shadows, double size, std::size_t max_cells) {
  Cutter cutter(cell, normal, size, max_cells);
  const std::vector<Vec3> corners = corners_of(shadows);
  for (const ShadowEdge& edge : shadows.edges) {
    for (int k = 0; k < inner.count; ++k) cutter.cut({inner[k], edge.p, edge.q, true});
  }
  for (const Vec3& corner : corners) {
    for (int k = 0; k < inner.count; ++k) cutter.cut({corner, inner[k], inner.next(k), false});
  }
  if (shadows.count() < 2) return cutter.take();
  // corners of one shadow in line with edges of another, on this side of it or beyond
  for (int cone = 0; cone < shadows.count(); ++cone) {
    for (int e = shadows.begin[cone]; e < shadows.begin[cone + 1]; ++e) {
      const ShadowEdge& edge = shadows.edges[e];
      for (int o = 0; o < static_cast<int>(shadows.edges.size()); ++o) {
        if (o >= shadows.begin[cone] && o < shadows.begin[cone + 1]) continue;
        if (shadows.tie(e, o) != 0) continue;
        for (const Vec3& corner : {shadows.edges[o].p, shadows.edges[o].q}) {
          cutter.cut({corner, edge.p, edge.q, true});
          cutter.cut({corner, edge.p, edge.q, false});
        }
      }
    }
  }
  return cutter.take();
}

}  // namespace luxel
