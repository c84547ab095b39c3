#include "graded_fill.h"

#include <algorithm>
#include <limits>
#include <unordered_map>

#include "angle.h"
#include "edge_key.h"
#include "widen_angles.h"

namespace luxel {

namespace {

// How often a polygon's neighbours may be told of points on their edges. Rooms need up to ten.
constexpr int rounds = 40;

// What parts of an edge may be halved down to, as a share of those that it was divided into: six halvings
// make up for a part of a polygon some sixty times narrower than patches are long. Without an end, polygons
// that meet in a sharp corner would halve their edges there in turn down to rounding.
constexpr double least_share = 1.0 / 64;

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

/// Grades the fills of a plan, one after the other, until none waits for points any more.
class Grader {
 public:
  Grader(std::vector<PolygonFill> fills, double smallest_angle, SurfacePlan& plan, PolygonFiller& filler,
         std::vector<Vec3>& vertices)
      : fills_(std::move(fills)),
        smallest_angle_(smallest_angle),
        plan_(plan),
        filler_(filler),
        vertices_(vertices),
        before_(vertices.size()),
        most_(vertices.size() + most_added +
              static_cast<std::size_t>(most_added_share * static_cast<double>(vertices.size()))),
        fills_on_edge_(plan.edges.size()),
        least_(plan.edges.size(), std::numeric_limits<double>::infinity()),
        changed_(fills_.size(), false) {
    for (int e = 0; e < plan.edges.size(); ++e) {
      if (plan.edges.is_given(e)) continue;
      const auto [a, b] = plan.edges.ends(e);
      least_[e] = least_share * (vertices[b] - vertices[a]).norm() / plan.edges.parts(e);
    }
    for (int i = 0; i < static_cast<int>(fills_.size()); ++i) {
      waiting_.push_back(has_below(smallest_angle, fills_[i], vertices));
      for (const auto& [a, b] : plan.merged.polygons.border(fills_[i].polygon)) note(i, a, b);
      for (const auto& [a, b] : plan.creases[fills_[i].polygon]) note(i, a, b);
    }
  }

  GradedFills run() {
    for (int round = 0; round < rounds; ++round) {
      if (std::none_of(waiting_.begin(), waiting_.end(), [](char yes) { return yes; })) break;
      for (int i = 0; i < static_cast<int>(fills_.size()); ++i) {
        if (!waiting_[i] || vertices_.size() >= most_) continue;
        waiting_[i] = false;
        widen(i);
      }
    }
    for (std::size_t i = 0; i < fills_.size(); ++i) {
      if (changed_[i]) fills_[i] = filler_.refill(std::move(fills_[i]), vertices_);
    }
    return {std::move(fills_), vertices_.size() - before_, vertices_.size() < most_};
  }

 private:
  void note(int fill, int a, int b) { fills_on_edge_[plan_.edges.find(a, b)].push_back(fill); }

  void widen(int i) {
    PolygonDomain local = filler_.domain(fills_[i].polygon, fills_[i].inside, vertices_);
    std::vector<double> least;
    for (const int edge : local.edges) least.push_back(least_[edge]);
    const AddedPoints added = widen_angles(local.domain, least, smallest_angle_, most_ - vertices_.size());
    if (added.inside.empty() && added.halved.empty()) return;
    changed_[i] = true;
    halve(i, std::move(local), added.halved);
    for (const Vec2& point : added.inside) {
      fills_[i].inside.push_back(static_cast<int>(vertices_.size()));
      vertices_.push_back(plan_.merged.polygons.frames[fills_[i].polygon].lift(point));
    }
  }

  /// Halves parts of edges, for all polygons on them.
  void halve(int i, PolygonDomain local, const std::vector<std::array<int, 2>>& halved) {
    std::unordered_map<std::uint64_t, int> edge_of_part;
    std::size_t part = 0;
    for (const auto* list : {&local.domain.borders, &local.domain.creases}) {
      for (const auto& [a, b] : *list) edge_of_part.emplace(edge_key(a, b), local.edges[part++]);
    }
    for (const auto& [a, b] : halved) {
      const int edge = edge_of_part.at(edge_key(a, b));
      const int middle = static_cast<int>(local.vertices.size());
      local.vertices.push_back(static_cast<int>(vertices_.size()));
      vertices_.push_back(0.5 * (vertices_[local.vertices[a]] + vertices_[local.vertices[b]]));
      plan_.edges.insert(edge, local.vertices[a], local.vertices[b], local.vertices[middle]);
      edge_of_part.emplace(edge_key(a, middle), edge);
      edge_of_part.emplace(edge_key(middle, b), edge);
      for (const int other : fills_on_edge_[edge]) {
        if (other != i) waiting_[other] = changed_[other] = true;
      }
    }
  }

  std::vector<PolygonFill> fills_;
  double smallest_angle_;
  SurfacePlan& plan_;
  PolygonFiller& filler_;
  std::vector<Vec3>& vertices_;
  std::size_t before_, most_;  // vertices at first, and at the end at most
  std::vector<std::vector<int>> fills_on_edge_;
  std::vector<double> least_;  // for each edge the length that halves of its parts must keep
  std::vector<char> waiting_, changed_;
};

}  // namespace

GradedFills grade(std::vector<PolygonFill> fills, double smallest_angle, SurfacePlan& plan,
                  PolygonFiller& filler, std::vector<Vec3>& vertices) {
  return Grader(std::move(fills), smallest_angle, plan, filler, vertices).run();
}

}  // namespace luxel
