#include "weld.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "order_by_key.h"
#include "polygon.h"

namespace luxel {

namespace {

// As a share of the scene's diagonal: above the rounding of nine-digit text, a hundred times below the
// thinnest wall or gap (1e-6) that must survive.
constexpr double weld_distance = 1e-8;

// As a share of the shortest edge at a vertex: no body can be deformed by more than this.
constexpr double weld_share_of_edge = 1e-3;

// Most that rounding can move a vertex along the line that vertices are sorted on, in roundings of the
// coordinates (4 units in the last place each): three differences, three products and two sums.
constexpr double roundings_along_line = 16;

// Steps that the line is divided into: a hundred or so to the weld distance; three digits of the sort.
constexpr double steps_along_line = 0x1p33;

// Places on that line that are looked at on either side of a vertex: where more vertices lie that near, all
// of them count as having a neighbour.
constexpr std::size_t most_along_line = 16;

/// Whether another vertex lies within `distance` of each; perhaps also for a few that have none. Vertices are
/// sorted along a line that no common mesh is aligned with, so that hardly any but real neighbours stand side
/// by side there. Cost: linear.
std::vector<char> have_neighbours(const std::vector<Vec3>& points, double distance, double noise) {
  std::vector<char> near(points.size(), false);
  if (points.size() < 2) return near;
  // Three numbers without a ratio of small integers, nor their sums or differences.
  const Vec3 line = Vec3(std::sqrt(2.0), std::cbrt(5.0), std::sqrt(7.0)).normalized();
  std::vector<double> places;
  places.reserve(points.size());
  for (const Vec3& p : points) places.push_back((p - points.front()).dot(line));
  const auto [low, high] = std::minmax_element(places.begin(), places.end());
  const double first = *low;
  const double extent = *high - first;
  const double steps_per_metre = steps_along_line / extent;
  if (!(extent > 0) || !std::isfinite(steps_per_metre)) return std::vector<char>(points.size(), true);
  std::vector<std::uint64_t> keys;
  keys.reserve(points.size());
  for (const double place : places) {
    keys.push_back(static_cast<std::uint64_t>((place - first) * steps_per_metre));
  }
  const double window = std::ceil((distance + roundings_along_line * noise) * steps_per_metre) + 1;
  const std::vector<int> order = order_by_key(keys);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const int a = order[i];
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const int b = order[j];
      if (static_cast<double>(keys[b] - keys[a]) > window) break;
      const bool crowded = j - i == most_along_line;
      if (crowded || (points[a] - points[b]).norm() <= distance) near[a] = near[b] = true;
      if (crowded) break;
    }
  }
  return near;
}

/// For each vertex that others are near how far it may move [m]; negative where no face uses it.
std::vector<double> reach_of_vertices(const Scene& scene, const std::vector<char>& near, double distance) {
  std::vector<double> shortest(scene.vertices.size(), -1);
  for (int f = 0; f < scene.face_count(); ++f) {
    const int begin = scene.face_offsets[f];
    const int count = scene.face_offsets[f + 1] - begin;
    for (int k = 0; k < count; ++k) {
      const int a = scene.face_vertices[begin + k];
      const int b = scene.face_vertices[begin + (k + 1) % count];
      if (!near[a] && !near[b]) continue;
      const double length = (scene.vertices[a] - scene.vertices[b]).norm();
      for (const int v : {a, b}) {
        if (shortest[v] < 0) shortest[v] = std::numeric_limits<double>::infinity();
        if (length > 0) shortest[v] = std::min(shortest[v], length);
      }
    }
  }
  for (double& reach : shortest) {
    if (reach >= 0) reach = std::min(distance, weld_share_of_edge * reach);
  }
  return shortest;
}

/// Positions kept so far, found by the cell that they lie in.
class KeptPositions {
 public:
  /// Room for `most` positions. Cells have twice the width of `distance`: all that is near a point lies in
  /// the 2 x 2 x 2 cells around it.
  KeptPositions(std::size_t most, const Vec3& origin, double distance)
      : origin_(origin),
        cells_per_metre_(distance > 0 ? 0.5 / distance : 1),
        slots_(std::bit_ceil(2 * most + 1), Slot{0, -1}) {}

  /// Calls visit(position) for all kept positions near p, perhaps also for others.
  template <class Visit>
  void visit_near(const Vec3& p, Visit&& visit) const {
    const Vec3 q = (p - origin_) * cells_per_metre_;
    Cell low = cell(q);
    for (int k = 0; k < 3; ++k) low[k] -= q[k] - std::floor(q[k]) < 0.5 ? 1 : 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Slot& slot =
          slots_[slot_of({low[0] + (corner & 1), low[1] + (corner >> 1 & 1), low[2] + (corner >> 2)})];
      for (int link = slot.last; link >= 0; link = links_[link].before) visit(links_[link].position);
    }
  }

  void add(const Vec3& p, int position) {
    const Cell own = cell((p - origin_) * cells_per_metre_);
    Slot& slot = slots_[slot_of(own)];
    links_.push_back({position, slot.last});
    slot = {hash(own), static_cast<int>(links_.size()) - 1};
  }

 private:
  using Cell = std::array<std::int64_t, 3>;

  struct Slot {  // of an open table; cells whose hashes are equal share one
    std::uint64_t hash;
    int last;  // link; -1: free
  };

  struct Link {
    int position;
    int before;  // link in the same cell; -1: none
  };

  static Cell cell(const Vec3& q) {
    return {std::llround(std::floor(q[0])), std::llround(std::floor(q[1])), std::llround(std::floor(q[2]))};
  }

  static std::uint64_t hash(const Cell& cell) {
    std::uint64_t h = 0x9e3779b97f4a7c15ull;
    for (const std::int64_t x : cell) {
      h = (h ^ static_cast<std::uint64_t>(x)) * 0xff51afd7ed558ccdull;
      h ^= h >> 32;
    }
    return h;
  }

  std::size_t slot_of(const Cell& cell) const {
    const std::uint64_t h = hash(cell);
    std::size_t slot = h & (slots_.size() - 1);
    while (slots_[slot].last >= 0 && slots_[slot].hash != h) slot = (slot + 1) & (slots_.size() - 1);
    return slot;
  }

  Vec3 origin_;
  double cells_per_metre_;
  std::vector<Slot> slots_;
  std::vector<Link> links_;
};

}  // namespace

double diagonal(const std::vector<Vec3>& points) {
  if (points.empty()) return 0;
  Vec3 low = points.front();
  Vec3 high = low;
  for (const Vec3& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).norm();
}

WeldedVertices weld(const Scene& scene) {
  const double noise = rounding(scene.vertices);
  const double distance = std::max(weld_distance * diagonal(scene.vertices), noise);
  const std::vector<char> near = have_neighbours(scene.vertices, distance, noise);
  const auto near_count = static_cast<std::size_t>(std::count(near.begin(), near.end(), true));
  std::vector<double> reach;
  if (near_count > 0) reach = reach_of_vertices(scene, near, distance);
  KeptPositions kept(near_count, scene.vertices.empty() ? Vec3::Zero() : scene.vertices.front(), distance);

  WeldedVertices result;
  result.index.assign(scene.vertices.size(), -1);
  result.positions.reserve(scene.vertices.size());
  std::vector<double> kept_reach;  // of positions, where others are near
  for (const int v : scene.face_vertices) {
    if (result.index[v] >= 0) continue;
    const Vec3& p = scene.vertices[v];
    int match = -1;
    if (near[v]) {
      kept.visit_near(p, [&](int w) {
        const double limit = std::max(noise, std::min(reach[v], kept_reach[w]));
        if ((result.positions[w] - p).norm() <= limit && (match < 0 || w < match)) match = w;
      });
    }
    if (match < 0) {
      match = static_cast<int>(result.positions.size());
      result.positions.push_back(p);
      if (near[v]) {
        kept_reach.resize(result.positions.size());
        kept_reach.back() = reach[v];
        kept.add(p, match);
      }
    } else {
      ++result.welded;
    }
    result.index[v] = match;
  }
  return result;
}

}  // namespace luxel
