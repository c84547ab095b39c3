#include "form_factors/patch_points.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <span>

#include "form_factors/gauss.h"

namespace luxel {

namespace {

// A symmetric triangle rule: orbits of the barycentric point (a, b, c) with the weight of each of its points.
struct Orbit {
  double a, b, c, weight;
};

// Degrees 1, 2, 4 and 6 with 1, 3, 6 and 12 points, all inside, all weights positive. Source: Dunavant 1985.
std::span<const Orbit> triangle_orbits(int level) {
  static constexpr double third = 1.0 / 3;
  static constexpr std::array<Orbit, 1> degree1{{{third, third, third, 1}}};
  static constexpr std::array<Orbit, 1> degree2{{{2.0 / 3, 1.0 / 6, 1.0 / 6, third}}};
  static constexpr std::array<Orbit, 2> degree4{
      {{0.108103018168070, 0.445948490915965, 0.445948490915965, 0.223381589678011},
       {0.816847572980459, 0.091576213509771, 0.091576213509771, 0.109951743655322}}};
  static constexpr std::array<Orbit, 3> degree6{
      {{0.501426509658179, 0.249286745170910, 0.249286745170910, 0.116786275726379},
       {0.873821971016996, 0.063089014491502, 0.063089014491502, 0.050844906370207},
       {0.053145049844817, 0.310352451033784, 0.636502499121399, 0.082851075618374}}};
  switch (level) {
    case 1:
      return degree1;
    case 2:
      return degree2;
    case 3:
      return degree4;
    default:
      return degree6;
  }
}

struct WeightedPoint {
  Vec3 x;
  double weight;
};

std::vector<WeightedPoint> triangle_points(const Polygon& triangle, double area, int level) {
  std::vector<WeightedPoint> points;
  for (const Orbit& orbit : triangle_orbits(level)) {
    std::array<double, 3> b{orbit.a, orbit.b, orbit.c};
    std::sort(b.begin(), b.end());
    do {
      points.push_back({b[0] * triangle[0] + b[1] * triangle[1] + b[2] * triangle[2], area * orbit.weight});
    } while (std::next_permutation(b.begin(), b.end()));
  }
  return points;
}

std::vector<WeightedPoint> quad_points(const Polygon& quad, const Vec3& normal, int level) {
  const GaussRule rule = gauss_rule(level);
  const Vec3 &a = quad[0], &b = quad[1], &c = quad[2], &d = quad[3];
  std::vector<WeightedPoint> points;
  for (int i = 0; i < level; ++i) {
    for (int j = 0; j < level; ++j) {
      const double s = rule.nodes[i], t = rule.nodes[j];
      const Vec3 along_s = (1 - t) * (b - a) + t * (c - d), along_t = (1 - s) * (d - a) + s * (c - b);
      points.push_back({a + s * along_s + t * (d - a),
                        along_s.cross(along_t).dot(normal) * rule.weights[i] * rule.weights[j]});
    }
  }
  return points;
}

int triangle_count(int level) {
  return std::array{0, 1, 3, 6, 12}[level];
}

}  // namespace

PatchPoints patch_points(const std::vector<WorkPatch>& patches, int level) {
  PatchPoints points;
  for (const WorkPatch& patch : patches) {
    points.count = std::max(points.count, patch.outline.count == 3 ? triangle_count(level) : level * level);
  }
  points.stride = static_cast<int>(patches.size()) + lane_padding;
  const std::size_t size = static_cast<std::size_t>(points.count) * points.stride;
  // Padding lies outside the scene, so that no distance to it is 0.
  points.x.assign(size, 1e3);
  points.y.assign(size, 1e3);
  points.z.assign(size, 1e3);
  points.weight.assign(size, 0);
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const WorkPatch& patch = patches[p];
    const std::vector<WeightedPoint> rule = patch.outline.count == 3
                                                ? triangle_points(patch.outline, patch.area, level)
                                                : quad_points(patch.outline, patch.plane.normal, level);
    for (int k = 0; k < points.count; ++k) {
      const bool real = k < static_cast<int>(rule.size());
      const Vec3& x = rule[real ? k : 0].x;
      const std::size_t at = static_cast<std::size_t>(k) * points.stride + p;
      points.x[at] = x[0], points.y[at] = x[1], points.z[at] = x[2];
      points.weight[at] = real ? rule[k].weight : 0;
    }
  }
  return points;
}

PatchPlanes patch_planes(const std::vector<WorkPatch>& patches) {
  PatchPlanes planes;
  const std::size_t size = patches.size() + lane_padding;
  planes.nx.assign(size, 0);
  planes.ny.assign(size, 0);
  planes.nz.assign(size, 1);
  planes.offset.assign(size, 0);
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const Plane& plane = patches[p].plane;
    planes.nx[p] = plane.normal[0], planes.ny[p] = plane.normal[1], planes.nz[p] = plane.normal[2];
    planes.offset[p] = plane.offset;
  }
  return planes;
}

}  // namespace luxel
