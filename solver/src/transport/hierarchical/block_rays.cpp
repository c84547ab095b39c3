#include "transport/hierarchical/block_rays.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "form_factors/ray_visibility.h"
#include "sampling/owen_sobol.h"

namespace luxel {

namespace {

constexpr int packet = 16;

// Rays start and end this far in front of their patches: as in ray_visibility.cpp.
constexpr double surface_offset = 4e-7;

// Powers of 1 / g, g the real root of x^5 = x + 1 (Roberts 2018).
constexpr std::array<double, 4> recurrence{0.8566748838545029, 0.7338918566271260, 0.6287067210378087,
                                           0.5385972572236101};

double unit(std::uint64_t x) {
  return static_cast<double>(x >> 11) * 0x1p-53;
}

// A point of a triangle or a convex quad, uniform on triangles and parallelograms.
Vec3 point_on(const Polygon& p, double u, double v) {
  if (p.count == 4) {
    return (1 - u) * (1 - v) * p[0] + u * (1 - v) * p[1] + u * v * p[2] + (1 - u) * v * p[3];
  }
  const double root = std::sqrt(u);
  return (1 - root) * p[0] + root * (1 - v) * p[1] + root * v * p[2];
}

}  // namespace

double RayCount::error() const {
  return all == 0 ? 0 : share_error(share(), all);
}

BlockRays::Point BlockRays::point(const BlockEnd& end, int node, double u, double v) const {
  const auto nearest_node = [&](const Vec3& x) {
    return (end.axes.u.dot(x - end.axes.middle) > 0 ? 1 : 0) +
           (end.axes.v.dot(x - end.axes.middle) > 0 ? 2 : 0);
  };
  if (end.single) {
    const Vec3 at = point_on(end.bounds.hull, 0.5 * ((node & 1) + u), 0.5 * ((node >> 1) + v));
    return {at, end.bounds.plane.normal, nearest_node(at)};
  }
  if (end.bounds.planar) {
    // the rectangle of equal moments, which is the cluster itself where it is one
    const double s = (node & 1 ? u : -u) * std::numbers::sqrt3 * end.axes.spread_s;
    const double t = (node & 2 ? v : -v) * std::numbers::sqrt3 * end.axes.spread_t;
    return {end.axes.middle + s * end.axes.u + t * end.axes.v, end.bounds.plane.normal, node};
  }
  // a patch of the node's quarter of the order, which follows position
  const PatchCluster& cluster = hierarchy_.clusters[end.cluster];
  const int size = cluster.end - cluster.begin;
  const double at = 0.25 * (node + u) * size;
  const int which = std::min(static_cast<int>(at), size - 1);
  const PatchMesh& mesh = *hierarchy_.mesh;
  const int patch = hierarchy_.order[cluster.begin + which];
  Polygon outline;
  outline.count = mesh.corner_count(patch);
  for (int k = 0; k < outline.count; ++k) {
    outline.corners[k] = hierarchy_.frame(mesh.vertices[mesh.corners[patch][k]]);
  }
  const Vec3 x = point_on(outline, at - which, v);
  return {x, mesh.normals[patch], nearest_node(x)};
}

void BlockRays::cast(const BlockEnd& r, const BlockEnd& s, int wanted, RayCount& count) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  std::uint64_t state =
      mixed_seed(seed_, static_cast<std::uint64_t>(r.cluster) << 32 | static_cast<std::uint64_t>(s.cluster));
  std::array<double, 4> shift;
  for (std::size_t c = 0; c < shift.size(); ++c) shift[c] = unit(state = mixed_seed(state, c));
  alignas(64) RTCRay16 rays;
  alignas(64) std::array<int, packet> valid;
  std::array<int, packet> pair;
  for (; count.drawn < wanted; count.drawn += packet) {
    for (int k = 0; k < packet; ++k) {
      std::array<double, 4> u;
      for (std::size_t c = 0; c < u.size(); ++c) {
        const double x = shift[c] + (count.drawn + k) * recurrence[c];
        u[c] = x - std::floor(x);
      }
      const Point from = point(r, k >> 2, u[0], u[1]), to = point(s, k & 3, u[2], u[3]);
      const Vec3 sight = to.at - from.at;
      const Vec3 start = from.at + surface_offset * from.normal;
      const Vec3 along = to.at + surface_offset * to.normal - start;
      pair[k] = 4 * from.node + to.node;
      valid[k] = sight.dot(from.normal) > 0 && sight.dot(to.normal) < 0 ? -1 : 0;
      rays.org_x[k] = static_cast<float>(start.x());
      rays.org_y[k] = static_cast<float>(start.y());
      rays.org_z[k] = static_cast<float>(start.z());
      rays.dir_x[k] = static_cast<float>(along.x());
      rays.dir_y[k] = static_cast<float>(along.y());
      rays.dir_z[k] = static_cast<float>(along.z());
      rays.tnear[k] = 0;
      rays.tfar[k] = 1;
      rays.time[k] = 0;
      rays.mask[k] = ~0u;
      rays.id[k] = static_cast<unsigned>(k);
      rays.flags[k] = 0;
    }
    rtcOccluded16(valid.data(), scene_, &context, &rays);
    for (int k = 0; k < packet; ++k) {
      if (valid[k] == 0) continue;
      const bool arrived = !(rays.tfar[k] < 0);
      ++count.cast[pair[k]];
      ++count.all;
      count.arrived[pair[k]] += arrived;
      count.visible += arrived;
    }
  }
}

}  // namespace luxel
