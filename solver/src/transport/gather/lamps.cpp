#include "transport/gather/lamps.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <unordered_map>

namespace luxel {

namespace {

// Corners that turn by less [sine] do not count: above the rounding of coordinates.
constexpr double straight = 1e-9;

// A frame with less outside the lamp is the lamp: above rounding.
constexpr double full = 1 - 1e-9;

/// Directed edges around a set of patches: those whose reverse is not there, straight runs joined.
std::vector<std::array<int, 2>> outline_of(const PatchMesh& mesh, std::span<const int> patches) {
  const auto key = [](int a, int b) {
    return static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint32_t>(b);
  };
  std::unordered_map<std::uint64_t, int> surplus;
  const auto each_edge = [&](auto&& visit) {
    for (int patch : patches) {
      const int count = mesh.corner_count(patch);
      for (int k = 0; k < count; ++k) visit(mesh.corners[patch][k], mesh.corners[patch][(k + 1) % count]);
    }
  };
  each_edge([&](int a, int b) { ++surplus[key(a, b)]; });
  std::unordered_map<int, std::vector<int>> next;
  std::unordered_map<int, int> previous;  // -1: several
  std::vector<int> order;
  each_edge([&](int a, int b) {
    if (surplus.contains(key(b, a))) return;
    next[a].push_back(b);
    order.push_back(a);
    const auto [at, fresh] = previous.try_emplace(b, a);
    if (!fresh) at->second = -1;
  });
  const auto passes = [&](int v) {
    const auto out = next.find(v);
    if (out == next.end() || out->second.size() != 1 || previous[v] < 0) return false;
    const Vec3 in = (mesh.vertices[v] - mesh.vertices[previous[v]]).normalized();
    const Vec3 on = (mesh.vertices[out->second[0]] - mesh.vertices[v]).normalized();
    return in.dot(on) > 0 && in.cross(on).norm() < straight;
  };
  std::vector<std::array<int, 2>> edges;
  std::sort(order.begin(), order.end());
  order.erase(std::unique(order.begin(), order.end()), order.end());
  for (int start : order) {
    if (passes(start)) continue;
    for (int end : next[start]) {
      while (passes(end)) end = next[end][0];
      edges.push_back({start, end});
    }
  }
  return edges;
}

/// The parallelogram or triangle that the outline is, or the smallest box along one of its edges.
void set_frame(Lamp& lamp) {
  const auto& edges = lamp.outline;
  const auto follows = [&](std::size_t k) { return edges[k][1] == edges[(k + 1) % edges.size()][0]; };
  const auto end_on_end = [&](std::size_t count) {
    if (edges.size() != count) return false;
    for (std::size_t k = 0; k < count; ++k) {
      if (!follows(k)) return false;
    }
    return true;
  };
  lamp.corner = edges[0][0];
  if (end_on_end(3)) {
    lamp.triangle = lamp.fills_frame = true;
    lamp.along = edges[0][1] - lamp.corner;
    lamp.up = edges[1][1] - lamp.corner;
    return;
  }
  double smallest = std::numeric_limits<double>::infinity();
  for (const auto& [a, b] : edges) {
    const Vec3 x = (b - a).normalized();
    const Vec3 y = lamp.normal.cross(x);
    Eigen::Array2d low(0, 0), high(0, 0);
    for (const auto& edge : edges) {
      const Eigen::Array2d p((edge[0] - a).dot(x), (edge[0] - a).dot(y));
      low = low.min(p);
      high = high.max(p);
    }
    const Eigen::Array2d size = high - low;
    if (!(size.prod() < smallest)) continue;
    smallest = size.prod();
    lamp.corner = a + low[0] * x + low[1] * y;
    lamp.along = size[0] * x;
    lamp.up = size[1] * y;
  }
}

}  // namespace

bool Lamp::holds(const Vec3& point) const {
  // crossings of a half line
  const Vec3 x = along.normalized(), y = normal.cross(x);
  const double px = point.dot(x), py = point.dot(y);
  bool inside = false;
  for (const auto& [a, b] : outline) {
    const double ay = a.dot(y) - py, by = b.dot(y) - py;
    if ((ay > 0) == (by > 0)) continue;
    const double ax = a.dot(x) - px, bx = b.dot(x) - px;
    if (ax + (bx - ax) * ay / (ay - by) > 0) inside = !inside;
  }
  return inside;
}

double Lamp::distance(const Vec3& point) const {
  const Vec3 from = point - corner;
  const double s = std::clamp(from.dot(along) / along.squaredNorm(), 0.0, 1.0);
  const double t = std::clamp(from.dot(up) / up.squaredNorm(), 0.0, 1.0);
  return (from - s * along - t * up).norm();
}

std::vector<Lamp> lamps_of(const PatchMesh& mesh, const PatchField& emission, const RayScene& occluders) {
  std::vector<int> emitters;
  for (int i = 0; i < mesh.size(); ++i) {
    if ((emission.row(i).array() > 0).any()) emitters.push_back(i);
  }
  // alike: the same polygon, side and emission
  std::vector<int> model(mesh.occluders.polygon_count, -1);
  const auto side = [&](int i) { return mesh.normals[i].dot(mesh.normals[model[mesh.polygons[i]]]) < 0; };
  for (int i : emitters) {
    if (model[mesh.polygons[i]] < 0) model[mesh.polygons[i]] = i;
  }
  const auto order = [&](int i, int j) {
    if (mesh.polygons[i] != mesh.polygons[j]) return mesh.polygons[i] < mesh.polygons[j] ? -1 : 1;
    if (side(i) != side(j)) return side(i) ? 1 : -1;
    for (Eigen::Index c = 0; c < emission.cols(); ++c) {
      if (emission(i, c) != emission(j, c)) return emission(i, c) < emission(j, c) ? -1 : 1;
    }
    return 0;
  };
  std::stable_sort(emitters.begin(), emitters.end(), [&](int i, int j) { return order(i, j) < 0; });

  std::vector<Lamp> lamps;
  for (std::size_t begin = 0; begin < emitters.size();) {
    std::size_t end = begin;
    while (end < emitters.size() && order(emitters[begin], emitters[end]) == 0) ++end;
    const std::span<const int> patches(emitters.data() + begin, end - begin);
    begin = end;
    const auto local = [&](int v) -> Vec3 {
      return (mesh.vertices[v] - occluders.centre()) * occluders.scale();
    };
    Lamp lamp;
    lamp.normal = mesh.normals[patches[0]];
    lamp.emission = emission.row(patches[0]);
    for (int patch : patches) lamp.area += mesh.areas[patch];
    for (const auto& [a, b] : outline_of(mesh, patches)) lamp.outline.push_back({local(a), local(b)});
    lamp.offset = lamp.normal.dot(lamp.outline[0][0]);
    set_frame(lamp);
    if (!lamp.triangle) {
      const double frame = lamp.along.cross(lamp.up).norm() / (occluders.scale() * occluders.scale());
      lamp.filled = std::min(1.0, lamp.area / frame);
      lamp.fills_frame = lamp.filled > full;
    }
    lamps.push_back(std::move(lamp));
  }
  return lamps;
}

// The part of the outline above the horizon is closed along the horizon: all its crossings lie on the line
// where the two planes meet, along which azimuths add up.
double form_factor(const Vec3& point, const Vec3& normal, const Lamp& lamp) {
  if (lamp.normal.dot(point) <= lamp.offset) return 0;
  double sum = 0;
  Vec3 reference = Vec3::Zero();
  bool crossed = false;
  const auto azimuth = [&](const Vec3& at) {
    if (!crossed) {
      reference = at;
      crossed = true;
      return 0.0;
    }
    return std::atan2(normal.dot(reference.cross(at)), reference.dot(at));
  };
  for (const auto& edge : lamp.outline) {
    Vec3 a = edge[0] - point, b = edge[1] - point;
    const double above_a = a.dot(normal), above_b = b.dot(normal);
    if (above_a <= 0 && above_b <= 0) continue;
    if (above_a < 0) {
      a += (b - a) * (above_a / (above_a - above_b));
      sum += azimuth(a);
    } else if (above_b < 0) {
      b += (a - b) * (above_b / (above_b - above_a));
      sum -= azimuth(b);
    }
    const Vec3 across = a.cross(b);
    const double sine = across.norm();
    if (sine > 0) sum += std::atan2(sine, a.dot(b)) * across.dot(normal) / sine;
  }
  // counter-clockwise seen from the point is clockwise about its normal
  return std::max(0.0, -sum / (2 * std::numbers::pi));
}

}  // namespace luxel
