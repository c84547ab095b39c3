#include "transport/hierarchical/block_rays.h"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "form_factors/ray_visibility.h"
#include "rays/visible_share.h"
#include "sampling/owen_sobol.h"
#include "sampling/sobol_words.h"

namespace luxel {

namespace {

constexpr int packet = 16;

// Of two single patches that are close.
constexpr int most_pairs_of_points = 4096;

// Rays start and end this far in front of their patches: as in ray_visibility.cpp.
constexpr double surface_offset = 4e-7;

// Powers of 1 / g, g the real root of x^5 = x + 1 (Roberts 2018).
constexpr std::array<double, 4> recurrence{0.8566748838545029, 0.7338918566271260, 0.6287067210378087,
                                           0.5385972572236101};

// Outermost points lie so far out from the middle: on the outermost patches of a million, and beside what
// stands where the end ends.
constexpr double outermost = 0.998;

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

int nearest_node(const BlockEnd& end, const Vec3& x) {
  return (end.axes.u.dot(x - end.axes.middle) > 0 ? 1 : 0) +
         (end.axes.v.dot(x - end.axes.middle) > 0 ? 2 : 0);
}

// Sixteen rays; ends(k) gives the points of the k-th. Tells on_ray(pair of nodes, arrived) of those that
// run in front of both ends.
template <class Ends, class OnRay>
void cast_packet(RTCSceneTy* scene, const Ends& ends, const OnRay& on_ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(64) RTCRay16 rays;
  alignas(64) std::array<int, packet> valid;
  std::array<int, packet> pair;
  for (int k = 0; k < packet; ++k) {
    const auto [from, to] = ends(k);
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
  rtcOccluded16(valid.data(), scene, &context, &rays);
  for (int k = 0; k < packet; ++k) {
    if (valid[k] != 0) on_ray(pair[k], !(rays.tfar[k] < 0));
  }
}

FrontPart front_part(const BlockEnd& end, const Plane& other) {
  Polygon outline = end.bounds.hull;
  for (int k = 0; k < outline.count; ++k) outline.corners[k] += surface_offset * end.bounds.plane.normal;
  return FrontPart(outline, other, false);
}

// Whether a point of its plane lies in a convex polygon.
bool inside(const Polygon& outline, const Vec3& normal, const Vec3& x) {
  for (int k = 0; k < outline.count; ++k) {
    if ((outline.next(k) - outline[k]).cross(x - outline[k]).dot(normal) < 0) return false;
  }
  return true;
}

}  // namespace

double RayCount::error() const {
  return all == 0 ? 0 : share_error(share(), all);
}

BlockRays::BlockRays(const PatchHierarchy& hierarchy, RTCSceneTy* scene, std::uint64_t seed)
    : hierarchy_(hierarchy), scene_(scene), seed_(seed) {
  if (!scene) return;
  areas_.reserve(hierarchy.order.size() + 1);
  areas_.push_back(0);
  for (int patch : hierarchy.order) areas_.push_back(areas_.back() + hierarchy.mesh->areas[patch]);
  words_ = reversed_sobol_words(most_pairs_of_points);
}

double BlockRays::visible_share(const BlockEnd& r, const BlockEnd& s, double allowed, int& rays) const {
  // the smaller end sees the more of the other
  const bool swapped = s.area < r.area;
  const BlockEnd &receiver = swapped ? s : r, &source = swapped ? r : s;
  const Plane &plane = receiver.bounds.plane, &far = source.bounds.plane;
  const Polygon& outline = source.bounds.hull;
  const SightEnds ends{front_part(receiver, far),
                       front_part(source, plane),
                       plane.normal,
                       far.normal,
                       far.offset + surface_offset,
                       true,
                       true,
                       [&](const Vec3& x) { return inside(outline, far.normal, x); }};
  if (ends.receiver.empty() || ends.source.empty()) return 1;  // of nothing
  VisibleShare visible(
      ends, scene_,
      mixed_seed(seed_, static_cast<std::uint64_t>(r.cluster) << 32 | static_cast<std::uint64_t>(s.cluster)));
  int drawn = 0;
  for (int wanted = packet; drawn < most_pairs_of_points; wanted *= 2) {
    for (; drawn < wanted; drawn += packet)
      visible.draw(packet, &words_[4 * static_cast<std::size_t>(drawn)]);
    const double certain = visible.equal_rays();
    if (certain > 0 && share_error(visible.share(), certain) <= allowed) break;
  }
  rays += visible.rays();
  return visible.rays() > 0 ? visible.share() : 1;
}

BlockRays::Point BlockRays::point_of_patch(const BlockEnd& end, int patch, double u, double v) const {
  const PatchMesh& mesh = *hierarchy_.mesh;
  Polygon outline;
  outline.count = mesh.corner_count(patch);
  for (int k = 0; k < outline.count; ++k) {
    outline.corners[k] = hierarchy_.frame(mesh.vertices[mesh.corners[patch][k]]);
  }
  const Vec3 x = point_on(outline, u, v);
  return {x, mesh.normals[patch], nearest_node(end, x)};
}

BlockRays::Point BlockRays::point(const BlockEnd& end, int node, double u, double v) const {
  if (end.single) {
    const Vec3 at = point_on(end.bounds.hull, 0.5 * ((node & 1) + u), 0.5 * ((node >> 1) + v));
    return {at, end.bounds.plane.normal, nearest_node(end, at)};
  }
  if (end.rectangle) {
    const double s = (node & 1 ? u : -u) * std::numbers::sqrt3 * end.axes.spread_s;
    const double t = (node & 2 ? v : -v) * std::numbers::sqrt3 * end.axes.spread_t;
    return {end.axes.middle + s * end.axes.u + t * end.axes.v, end.bounds.plane.normal, node};
  }
  // a patch of the node's quarter of the order, which follows position, by area
  const PatchCluster& cluster = hierarchy_.clusters[end.cluster];
  const auto begin = areas_.begin() + cluster.begin, last = areas_.begin() + cluster.end - 1;
  const double wanted = *begin + 0.25 * (node + u) * (last[1] - *begin);
  const auto at = std::upper_bound(begin + 1, last + 1, wanted) - 1;
  const double within = std::clamp((wanted - at[0]) / (at[1] - at[0]), 0.0, 1.0);
  return point_of_patch(end, hierarchy_.order[at - areas_.begin()], within, v);
}

BlockRays::Point BlockRays::corner(const BlockEnd& end, int node) const {
  if (end.single) {
    const Vec3& tip = end.bounds.hull[std::min(node, end.bounds.hull.count - 1)];
    const Vec3 at = end.bounds.centre + outermost * (tip - end.bounds.centre);
    return {at, end.bounds.plane.normal, node};
  }
  const double reach = outermost * std::numbers::sqrt3;
  const Vec3 out = (node & 1 ? reach : -reach) * end.axes.spread_s * end.axes.u +
                   (node & 2 ? reach : -reach) * end.axes.spread_t * end.axes.v;
  if (end.rectangle) return {end.axes.middle + out, end.bounds.plane.normal, node};
  int at = end.cluster;
  const auto centre = [&](int cluster) -> Vec3 {
    return hierarchy_.single(cluster)
               ? hierarchy_.frame(hierarchy_.mesh->centroids[hierarchy_.patch(cluster)])
               : hierarchy_.clusters[cluster].centre;
  };
  while (!hierarchy_.single(at)) {
    const PatchCluster& cluster = hierarchy_.clusters[at];
    at = *std::max_element(cluster.children.begin(), cluster.children.begin() + cluster.child_count,
                           [&](int a, int b) { return out.dot(centre(a)) < out.dot(centre(b)); });
  }
  const int patch = hierarchy_.patch(at);
  return {centre(at), hierarchy_.mesh->normals[patch], node};
}

void BlockRays::cast_between_corners(const BlockEnd& r, const BlockEnd& s, RayCount& count) const {
  std::array<Point, 4> of_r, of_s;
  for (int a = 0; a < 4; ++a) {
    of_r[a] = corner(r, a);
    of_s[a] = corner(s, a);
  }
  cast_packet(
      scene_, [&](int k) { return std::pair(of_r[k >> 2], of_s[k & 3]); },
      [&](int, bool arrived) {
        ++count.corners;
        count.corners_visible += arrived;
      });
}

void BlockRays::cast(const BlockEnd& r, const BlockEnd& s, int wanted, RayCount& count) const {
  std::uint64_t state =
      mixed_seed(seed_, static_cast<std::uint64_t>(r.cluster) << 32 | static_cast<std::uint64_t>(s.cluster));
  std::array<double, 4> shift;
  for (std::size_t c = 0; c < shift.size(); ++c) shift[c] = unit(state = mixed_seed(state, c));
  for (; count.drawn < wanted; count.drawn += packet) {
    const auto points = [&](int k) {
      std::array<double, 4> u;
      for (std::size_t c = 0; c < u.size(); ++c) {
        const double x = shift[c] + (count.drawn + k) * recurrence[c];
        u[c] = x - std::floor(x);
      }
      return std::pair(point(r, k >> 2, u[0], u[1]), point(s, k & 3, u[2], u[3]));
    };
    cast_packet(scene_, points, [&](int pair, bool arrived) {
      ++count.cast[pair];
      ++count.all;
      count.arrived[pair] += arrived;
      count.visible += arrived;
    });
  }
}

}  // namespace luxel
