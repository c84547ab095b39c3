#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "ear_clipping.h"
#include "triangulate.h"

namespace luxel {

namespace {

// Longest border that ears are clipped from: the cost is quadratic, and 4000 corners take about 0.1 s.
constexpr std::size_t longest_border = 4000;

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double signed_area(const std::vector<Vec2>& points, const std::vector<int>& loop) {
  double sum = 0;
  const Vec2& origin = points[loop[0]];
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
    sum += cross(points[loop[i]] - origin, points[loop[i + 1]] - origin);
  }
  return sum / 2;
}

/// The loops that the border edges form; where several leave a point, the sharpest left turn is taken, which
/// keeps loops that touch at a point apart. Nothing if an edge leads nowhere.
std::optional<std::vector<std::vector<int>>> chain(const PlanarDomain& domain) {
  std::multimap<int, int> leaving;
  for (const auto& [a, b] : domain.borders) leaving.emplace(a, b);
  std::vector<std::vector<int>> loops;
  while (!leaving.empty()) {
    std::vector<int> loop = {leaving.begin()->first};
    int at = leaving.begin()->second;
    leaving.erase(leaving.begin());
    while (at != loop.front()) {
      const auto [begin, end] = leaving.equal_range(at);
      if (begin == end) return {};
      const Vec2 in = domain.points[at] - domain.points[loop.back()];
      auto best = begin;
      double sharpest = -std::numeric_limits<double>::infinity();
      for (auto it = begin; it != end; ++it) {
        const Vec2 out = domain.points[it->second] - domain.points[at];
        const double turn = std::atan2(cross(in, out), in.dot(out));
        if (turn > sharpest) {
          sharpest = turn;
          best = it;
        }
      }
      loop.push_back(at);
      at = best->second;
      leaving.erase(best);
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

bool crosses(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const double c_side = cross(b - a, c - a);
  const double d_side = cross(b - a, d - a);
  const double a_side = cross(d - c, a - c);
  const double b_side = cross(d - c, b - c);
  return ((c_side > 0) != (d_side > 0)) && ((a_side > 0) != (b_side > 0));
}

/// Joins a hole to the loop by a bridge from its rightmost point to the nearest point of the loop that sees
/// it.
bool bridge(const PlanarDomain& domain, std::vector<int>& loop, const std::vector<int>& hole) {
  const auto rightmost = std::max_element(
      hole.begin(), hole.end(), [&](int a, int b) { return domain.points[a].x() < domain.points[b].x(); });
  const Vec2& from = domain.points[*rightmost];
  std::size_t best = loop.size();
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec2& to = domain.points[loop[k]];
    const double distance = (to - from).squaredNorm();
    if (distance >= nearest) continue;
    // The bridge must leave into the inside of the loop at its corner.
    const Vec2& before = domain.points[loop[(k + loop.size() - 1) % loop.size()]];
    const Vec2& after = domain.points[loop[(k + 1) % loop.size()]];
    const bool left_of_in = cross(to - before, from - before) > 0;
    const bool left_of_out = cross(after - to, from - to) > 0;
    const bool convex = cross(to - before, after - to) >= 0;
    if (convex ? !(left_of_in && left_of_out) : !(left_of_in || left_of_out)) continue;
    bool seen = true;
    for (const auto& [a, b] : domain.borders) {
      if (a == loop[k] || b == loop[k] || a == *rightmost || b == *rightmost) continue;
      if (crosses(from, to, domain.points[a], domain.points[b])) {
        seen = false;
        break;
      }
    }
    if (!seen) continue;
    nearest = distance;
    best = k;
  }
  if (best == loop.size()) return false;
  std::vector<int> detour;
  detour.insert(detour.end(), rightmost, hole.end());
  detour.insert(detour.end(), hole.begin(), rightmost + 1);
  detour.push_back(loop[best]);
  loop.insert(loop.begin() + static_cast<std::ptrdiff_t>(best) + 1, detour.begin(), detour.end());
  return true;
}

bool inside(const PlanarDomain& domain, const std::vector<int>& loop, const Vec2& p) {
  bool in = false;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec2& a = domain.points[loop[k]];
    const Vec2& b = domain.points[loop[(k + 1) % loop.size()]];
    if ((a.y() > p.y()) != (b.y() > p.y()) && (cross(b - a, p - a) > 0) == (b.y() > a.y())) in = !in;
  }
  return in;
}

}  // namespace

std::optional<std::vector<std::array<int, 3>>> triangulate_by_ears(const PlanarDomain& domain) {
  if (domain.borders.size() > longest_border) return {};
  const auto loops = chain(domain);
  if (!loops) return {};
  std::vector<std::vector<int>> outer, holes;
  for (const auto& loop : *loops) (signed_area(domain.points, loop) > 0 ? outer : holes).push_back(loop);
  // Rightmost hole first: its bridge cannot be blocked by a hole that is not joined yet.
  const auto right = [&](const std::vector<int>& loop) {
    double x = -std::numeric_limits<double>::infinity();
    for (const int v : loop) x = std::max(x, domain.points[v].x());
    return x;
  };
  std::stable_sort(holes.begin(), holes.end(),
                   [&](const auto& a, const auto& b) { return right(a) > right(b); });
  for (const auto& hole : holes) {
    const Vec2 sample = domain.points[hole[0]];
    bool joined = false;
    for (auto& loop : outer) {
      if (joined || (outer.size() > 1 && !inside(domain, loop, sample))) continue;
      joined = bridge(domain, loop, hole);
    }
    if (!joined) return {};
  }
  std::vector<std::array<int, 3>> triangles;
  for (const auto& loop : outer) {
    std::vector<Vec2> points;
    for (const int v : loop) points.push_back(domain.points[v]);
    for (const auto& [a, b, c] : clip_ears(points)) triangles.push_back({loop[a], loop[b], loop[c]});
  }
  return triangles;
}

}  // namespace luxel
