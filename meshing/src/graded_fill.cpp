#include "graded_fill.h"

#include <algorithm>
#include <cstdint>
#include <unordered_map>

#include "angle.h"
#include "widen_angles.h"

namespace luxel {

namespace {

// How often a polygon's neighbours may be told of points on their edges. Rooms need up to ten.
constexpr int rounds = 40;

// Points that may be added: this many, and this share of those that there are. Narrow parts of a room of a
// few polygons need some hundred; a corner of a thousandth of a degree would need millions.
constexpr std::size_t most_added = 1000;
constexpr double most_added_share = 0.25;

bool has_below(double smallest_angle, const PolygonFill& fill, const std::vector<Vec3>& vertices) {
  return std::any_of(fill.triangles.begin(), fill.triangles.end(), [&](const std::array<int, 3>& t) {
    for (int k = 0; k < 3; ++k) {
      const Vec3& p = vertices[t[k]];
      if (angle_between(vertices[t[(k + 1) % 3]] - p, vertices[t[(k + 2) % 3]] - p) < smallest_angle)
        return true;
    }
    return false;
  });
}

std::uint64_t key(int a, int b) {
  return static_cast<std::uint64_t>(std::min(a, b)) << 32 | static_cast<std::uint32_t>(std::max(a, b));
}

}  // namespace

GradedFills grade(std::vector<PolygonFill> fills, double smallest_angle, SurfacePlan& plan,
                  PolygonFiller& filler, std::vector<Vec3>& vertices) {
  std::vector<std::vector<int>> fills_on_edge(plan.edges.size());
  std::vector<char> waiting(fills.size()), changed(fills.size(), false);
  for (int i = 0; i < static_cast<int>(fills.size()); ++i) {
    waiting[i] = has_below(smallest_angle, fills[i], vertices);
    const int p = fills[i].polygon;
    const auto note = [&](std::span<const std::array<int, 2>> list) {
      for (const auto& [a, b] : list) fills_on_edge[plan.edges.find(a, b)].push_back(i);
    };
    note(plan.merged.polygons.border(p));
    note(plan.creases[p]);
  }
  const auto most =
      most_added + static_cast<std::size_t>(most_added_share * static_cast<double>(vertices.size()));
  const std::size_t before = vertices.size();
  for (int round = 0; round < rounds; ++round) {
    if (std::none_of(waiting.begin(), waiting.end(), [](char yes) { return yes; })) break;
    for (int i = 0; i < static_cast<int>(fills.size()); ++i) {
      if (!waiting[i] || vertices.size() >= before + most) continue;
      waiting[i] = false;
      const int p = fills[i].polygon;
      PolygonDomain local = filler.domain(p, fills[i].inside, vertices);
      std::vector<char> fixed;
      for (const int edge : local.edges) fixed.push_back(plan.edges.is_given(edge));
      const AddedPoints added =
          widen_angles(local.domain, fixed, smallest_angle, before + most - vertices.size());
      if (added.inside.empty() && added.halved.empty()) continue;
      changed[i] = true;

      std::unordered_map<std::uint64_t, int> edge_of_part;
      std::size_t part = 0;
      for (const auto* list : {&local.domain.borders, &local.domain.creases}) {
        for (const auto& [a, b] : *list) edge_of_part.emplace(key(a, b), local.edges[part++]);
      }
      // points of the domain before those inside, which local.vertices lists last
      for (const auto& [a, b] : added.halved) {
        const int edge = edge_of_part.at(key(a, b));
        const int m = static_cast<int>(vertices.size());
        vertices.push_back(0.5 * (vertices[local.vertices[a]] + vertices[local.vertices[b]]));
        plan.edges.insert(edge, local.vertices[a], local.vertices[b], m);
        const int place = static_cast<int>(local.vertices.size());
        local.vertices.push_back(m);
        edge_of_part.emplace(key(a, place), edge);
        edge_of_part.emplace(key(place, b), edge);
        for (const int other : fills_on_edge[edge]) {
          if (other != i) waiting[other] = changed[other] = true;
        }
      }
      for (const Vec2& point : added.inside) {
        fills[i].inside.push_back(static_cast<int>(vertices.size()));
        vertices.push_back(plan.merged.polygons.frames[p].lift(point));
      }
    }
  }
  for (std::size_t i = 0; i < fills.size(); ++i) {
    if (changed[i]) fills[i] = filler.refill(std::move(fills[i]), vertices);
  }
  return {std::move(fills), vertices.size() - before, vertices.size() < before + most};
}

}  // namespace luxel
