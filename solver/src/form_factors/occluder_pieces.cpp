#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "form_factors/occluder_set.h"

namespace luxel {

namespace {

using Point = Eigen::Vector2d;
using Loop = std::vector<Point>;

// A corner is straight, and a piece still convex, where it deviates by less than this share of the lengths
// around it: above the noise of files with 9 digits.
constexpr double straight = 1e-8;

// The hull of a polygon's triangles is the polygon where the areas agree to this share.
constexpr double same_area = 1e-9;

double cross(const Point& a, const Point& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double area(const Loop& loop) {
  double twice = 0;
  for (std::size_t k = 0; k < loop.size(); ++k) twice += cross(loop[k], loop[(k + 1) % loop.size()]);
  return twice / 2;
}

// How far b bends to the left between a and c, relative to the lengths: negative for a reflex corner.
double bend(const Point& a, const Point& b, const Point& c) {
  const Point u = b - a, v = c - b;
  const double lengths = u.norm() * v.norm();
  return lengths > 0 ? cross(u, v) / lengths : 0;
}

Loop without_straight_corners(Loop loop) {
  for (std::size_t k = 0; loop.size() > 3 && k < loop.size();) {
    const std::size_t n = loop.size();
    if (std::abs(bend(loop[(k + n - 1) % n], loop[k], loop[(k + 1) % n])) < straight) {
      loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(k));
      k = k > 0 ? k - 1 : 0;
    } else {
      ++k;
    }
  }
  return loop;
}

// Andrew's monotone chain.
Loop hull(Loop points) {
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  Loop chain;
  for (int half = 0; half < 2; ++half) {
    const std::size_t start = chain.size();
    for (const Point& p : points) {
      while (chain.size() >= start + 2 &&
             cross(chain.back() - chain[chain.size() - 2], p - chain.back()) <= 0) {
        chain.pop_back();
      }
      chain.push_back(p);
    }
    chain.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return chain;
}

// Where one piece's edge runs from a to b and another's from b to a.
struct Seam {
  std::size_t first, first_edge, second, second_edge;
};

// Joins convex pieces over common edges while the result is convex (Hertel and Mehlhorn 1983).
class Joiner {
 public:
  Joiner(const std::vector<Point>& points, std::span<const std::array<int, 3>> triangles) : points_(points) {
    for (const auto& t : triangles) pieces_.push_back({t[0], t[1], t[2]});
  }

  std::vector<std::vector<int>> join() {
    std::map<std::pair<int, int>, std::size_t> owner;
    for (std::size_t k = 0; k < pieces_.size(); ++k) register_edges(owner, k);
    std::vector<std::pair<int, int>> edges;
    for (const auto& [edge, piece] : owner) edges.push_back(edge);
    for (const auto& [a, b] : edges) {
      const auto here = owner.find({a, b}), there = owner.find({b, a});
      if (here == owner.end() || there == owner.end() || here->second == there->second) continue;
      const std::size_t first = here->second, second = there->second;
      std::vector<int> joined = merged(pieces_[first], pieces_[second], a, b);
      if (!convex(joined)) continue;
      pieces_[second].clear();
      pieces_[first] = std::move(joined);
      owner.erase({a, b});
      owner.erase({b, a});
      register_edges(owner, first);
    }
    std::erase_if(pieces_, [](const auto& piece) { return piece.empty(); });
    return std::move(pieces_);
  }

 private:
  void register_edges(std::map<std::pair<int, int>, std::size_t>& owner, std::size_t piece) const {
    const auto& loop = pieces_[piece];
    for (std::size_t k = 0; k < loop.size(); ++k) owner[{loop[k], loop[(k + 1) % loop.size()]}] = piece;
  }

  // `first` without its edge a-b, round by way of `second`.
  static std::vector<int> merged(const std::vector<int>& first, const std::vector<int>& second, int a,
                                 int b) {
    std::vector<int> joined;
    const auto from = static_cast<std::size_t>(std::find(first.begin(), first.end(), b) - first.begin());
    for (std::size_t k = 0; k < first.size(); ++k) joined.push_back(first[(from + k) % first.size()]);
    const auto into = static_cast<std::size_t>(std::find(second.begin(), second.end(), a) - second.begin());
    for (std::size_t k = 1; k + 1 < second.size(); ++k) joined.push_back(second[(into + k) % second.size()]);
    return joined;
  }

  bool convex(const std::vector<int>& loop) const {
    const std::size_t n = loop.size();
    std::size_t corners = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const double turn = bend(points_[loop[(k + n - 1) % n]], points_[loop[k]], points_[loop[(k + 1) % n]]);
      if (turn < -straight) return false;
      corners += turn > straight;
    }
    return corners <= OccluderFace::max_corners;
  }

  const std::vector<Point>& points_;
  std::vector<std::vector<int>> pieces_;
};

}  // namespace

std::vector<Polygon> convex_pieces(std::span<const Vec3> vertices,
                                   std::span<const std::array<int, 3>> triangles, const Vec3& normal) {
  // the frame is askew, so that no side of a rectangle is parallel to the sweep of the hull
  const Vec3 side = (vertices[triangles[0][1]] - vertices[triangles[0][0]]).normalized();
  const Vec3 u = std::cos(0.37) * side + std::sin(0.37) * normal.cross(side);
  const Vec3 v = normal.cross(u);
  const Vec3 origin = vertices[triangles[0][0]];
  std::map<int, int> number;
  std::vector<Point> points;
  std::vector<const Vec3*> sources;
  std::vector<std::array<int, 3>> flat(triangles.begin(), triangles.end());
  double total = 0;
  for (auto& t : flat) {
    for (int& vertex : t) {
      const auto [found, fresh] = number.try_emplace(vertex, static_cast<int>(points.size()));
      if (fresh) {
        const Vec3 x = vertices[vertex] - origin;
        points.emplace_back(x.dot(u), x.dot(v));
        sources.push_back(&vertices[vertex]);
      }
      vertex = found->second;
    }
    total += cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]) / 2;
  }
  // corners come back as the vertices that they are, bit for bit, so that neighbours share their edges
  auto lifted = [&](const Loop& loop) {
    Polygon polygon;
    for (const Point& p : loop) {
      const auto found = std::find(points.begin(), points.end(), p);
      polygon.corners[polygon.count++] = *sources[static_cast<std::size_t>(found - points.begin())];
    }
    return polygon;
  };

  std::vector<Polygon> pieces;
  const Loop whole = without_straight_corners(hull(points));
  if (whole.size() <= OccluderFace::max_corners && std::abs(area(whole) - total) <= same_area * total) {
    pieces.push_back(lifted(whole));
    return pieces;
  }
  for (const auto& piece : Joiner(points, flat).join()) {
    Loop loop;
    for (int k : piece) loop.push_back(points[k]);
    pieces.push_back(lifted(without_straight_corners(loop)));
  }
  return pieces;
}

}  // namespace luxel
