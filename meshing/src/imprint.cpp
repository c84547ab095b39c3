#include "imprint.h"

#include <algorithm>
#include <cmath>

#include "box_tree.h"
#include "vertices_on_edges.h"

namespace luxel {

namespace {

using Segment = std::array<int, 2>;

Segment undirected(const Segment& s) {
  return {std::min(s[0], s[1]), std::max(s[0], s[1])};
}

double side(const Vec2& a, const Vec2& b, const Vec2& p) {
  return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
}

bool cross(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  return (side(a, b, c) > 0) != (side(a, b, d) > 0) && (side(c, d, a) > 0) != (side(c, d, b) > 0);
}

bool share_an_end(const Segment& s, const Segment& t) {
  return s[0] == t[0] || s[0] == t[1] || s[1] == t[0] || s[1] == t[1];
}

bool contains(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& p) {
  const double turn = side(a, b, c) >= 0 ? 1 : -1;
  return turn * side(a, b, p) >= 0 && turn * side(b, c, p) >= 0 && turn * side(c, a, p) >= 0;
}

}  // namespace

std::vector<std::vector<Segment>> find_contact_edges(const std::vector<Vec3>& vertices,
                                                     const MergedPolygons& merged,
                                                     const std::vector<char>& wanted) {
  const double distance = touching_distance(vertices);
  std::vector<Segment> edges;
  for (const Segment& segment : merged.polygons.segments) edges.push_back(undirected(segment));
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<Box> boxes;
  for (const auto& [a, b] : edges) {
    boxes.emplace_back(vertices[a].cwiseMin(vertices[b]), vertices[a].cwiseMax(vertices[b]));
  }
  const BoxTree tree(std::move(boxes));

  std::vector<std::vector<Segment>> contacts(merged.polygons.size());
  std::vector<Segment> own;
  std::vector<int> candidates;
  for (int p = 0; p < merged.polygons.size(); ++p) {
    if (!wanted[p]) continue;
    const Frame& frame = merged.polygons.frames[p];
    Box box;
    own.clear();
    for (const Segment& segment : merged.polygons.border(p)) {
      own.push_back(undirected(segment));
      box.extend(vertices[segment[0]]);
    }
    std::sort(own.begin(), own.end());
    box.min().array() -= distance;
    box.max().array() += distance;
    candidates.clear();
    tree.query(box, [&](int e) {
      const auto [a, b] = edges[e];
      if (std::abs(frame.height(vertices[a])) > distance || std::abs(frame.height(vertices[b])) > distance)
        return;
      if (!std::binary_search(own.begin(), own.end(), edges[e])) candidates.push_back(e);
    });
    std::sort(candidates.begin(), candidates.end());
    for (const int e : candidates) {
      const Vec2 a = frame.flat(vertices[edges[e][0]]);
      const Vec2 b = frame.flat(vertices[edges[e][1]]);
      const Vec2 middle = 0.5 * (a + b);
      const bool inside = std::ranges::any_of(merged.triangles[p], [&](const auto& t) {
        return contains(frame.flat(vertices[t[0]]), frame.flat(vertices[t[1]]), frame.flat(vertices[t[2]]),
                        middle);
      });
      const auto crosses = [&](const Segment& other) {
        return !share_an_end(edges[e], other) &&
               cross(a, b, frame.flat(vertices[other[0]]), frame.flat(vertices[other[1]]));
      };
      if (inside && !std::ranges::any_of(own, crosses) && !std::ranges::any_of(contacts[p], crosses)) {
        contacts[p].push_back(edges[e]);
      }
    }
  }
  return contacts;
}

}  // namespace luxel
