#include "weld.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>

#include "polygon.h"

namespace luxel {

namespace {

// As a share of the scene's diagonal: above the rounding of nine-digit text, a hundred times below the
// thinnest wall or gap (1e-6) that must survive.
constexpr double weld_distance = 1e-8;

// As a share of the shortest edge at a vertex: no body can be deformed by more than this.
constexpr double weld_share_of_edge = 1e-3;

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::uint64_t h = 0x9e3779b97f4a7c15ull;
    for (const std::int64_t x : cell) {
      h = (h ^ static_cast<std::uint64_t>(x)) * 0xff51afd7ed558ccdull;
      h ^= h >> 32;
    }
    return h;
  }
};

/// For each vertex how far it may move [m]; negative where no face uses it.
std::vector<double> reach_of_vertices(const Scene& scene, double distance) {
  std::vector<double> shortest(scene.vertices.size(), -1);
  for (int f = 0; f < scene.face_count(); ++f) {
    const int begin = scene.face_offsets[f];
    const int count = scene.face_offsets[f + 1] - begin;
    for (int k = 0; k < count; ++k) {
      const int a = scene.face_vertices[begin + k];
      const int b = scene.face_vertices[begin + (k + 1) % count];
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
  const std::vector<double> reach = reach_of_vertices(scene, distance);
  const Vec3 origin = scene.vertices.empty() ? Vec3::Zero() : scene.vertices.front();
  // Cells of twice the distance: all that is near a point lies in the 2 x 2 x 2 cells around it.
  const double cells_per_metre = distance > 0 ? 0.5 / distance : 1;

  WeldedVertices result;
  result.index.assign(scene.vertices.size(), -1);
  std::vector<double> kept_reach;
  std::vector<int> next;  // chains the positions of one cell
  std::unordered_map<Cell, int, CellHash> heads;
  heads.reserve(scene.vertices.size());
  for (const int v : scene.face_vertices) {
    if (result.index[v] >= 0) continue;
    const Vec3& p = scene.vertices[v];
    const Vec3 q = (p - origin) * cells_per_metre;
    const Cell own = {std::llround(std::floor(q[0])), std::llround(std::floor(q[1])),
                      std::llround(std::floor(q[2]))};
    Cell low = own;
    for (int k = 0; k < 3; ++k) low[k] -= q[k] - std::floor(q[k]) < 0.5 ? 1 : 0;
    int match = -1;
    for (int corner = 0; corner < 8; ++corner) {
      const auto found =
          heads.find({low[0] + (corner & 1), low[1] + (corner >> 1 & 1), low[2] + (corner >> 2)});
      if (found == heads.end()) continue;
      for (int w = found->second; w >= 0; w = next[w]) {
        const double limit = std::max(noise, std::min(reach[v], kept_reach[w]));
        if ((result.positions[w] - p).norm() <= limit && (match < 0 || w < match)) match = w;
      }
    }
    if (match < 0) {
      match = static_cast<int>(result.positions.size());
      result.positions.push_back(p);
      kept_reach.push_back(reach[v]);
      const auto [head, fresh] = heads.try_emplace(own, match);
      next.push_back(fresh ? -1 : head->second);
      head->second = match;
    } else {
      ++result.welded;
    }
    result.index[v] = match;
  }
  return result;
}

}  // namespace luxel
