#include "form_factors/ray_visibility.h"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "rays/occluder_scene.h"

namespace luxel {

namespace {

// Rays start and end this far in front of their patches, in working coordinates: above the rounding of a
// coordinate in float (6e-8) and of a plane through such corners, below the thinnest wall (1e-6).
constexpr double surface_offset = 4e-7;

// Rays of a pair: the first lot, and the most that any pair gets.
constexpr int first_rays = 6;
constexpr int most_rays = 1 << 16;

constexpr int packet = 16;

// Quasi-random points leave an error of error_constant sqrt(p (1 - p)) N^-error_order in a share p: measured
// on partly hidden pairs of rotated boxes against clipping.
constexpr double error_constant = 1.5;
constexpr double error_order = 0.7;

// Most pairs that come to rays are wholly visible or wholly hidden after all: the share of a pair has the
// distribution Beta(prior, prior) before any ray is cast.
constexpr double prior = 0.15;

// Powers of 1 / g, g the real root of x^5 = x + 1: the additive recurrence of lowest discrepancy known in
// four dimensions (Roberts 2018).
constexpr std::array<double, 4> recurrence{0.8566748838545029, 0.7338918566271260, 0.6287067210378087,
                                           0.5385972572236101};

std::uint64_t mixed(std::uint64_t x) {  // splitmix64, Steele, Lea and Flood 2014
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

double unit(std::uint64_t x) {
  return static_cast<double>(x >> 11) * 0x1p-53;
}

// Point of a convex polygon: with the density of the bilinear map for quads, whose area element is in
// `stretch`; uniform by area else.
struct PatchPoint {
  Vec3 at;
  double stretch;
};

PatchPoint point_on_triangle(const Vec3& a, const Vec3& b, const Vec3& c, double u, double v) {
  const double root = std::sqrt(u);
  return {(1 - root) * a + root * (1 - v) * b + root * v * c, 1};
}

PatchPoint point_on(const Polygon& p, double u, double v) {
  if (p.count == 4) {
    const Vec3 along_u = (1 - v) * (p[1] - p[0]) + v * (p[2] - p[3]);
    const Vec3 along_v = (1 - u) * (p[3] - p[0]) + u * (p[2] - p[1]);
    return {(1 - u) * (1 - v) * p[0] + u * (1 - v) * p[1] + u * v * p[2] + (1 - u) * v * p[3],
            along_u.cross(along_v).norm()};
  }
  if (p.count == 3) return point_on_triangle(p[0], p[1], p[2], u, v);
  // the triangle of the fan in which u times the area falls, and where in it
  const double whole = area_vector(p).norm();
  double left = u * whole;
  for (int k = 1; k + 1 < p.count; ++k) {
    const double part = 0.5 * (p[k] - p[0]).cross(p[k + 1] - p[0]).norm();
    if (left <= part || k + 2 == p.count) {
      return point_on_triangle(p[0], p[k], p[k + 1], std::min(part > 0 ? left / part : 0.0, 1.0), v);
    }
    left -= part;
  }
  return {p[0], 1};
}

bool straddles(const WorkPatch& patch, const Plane& plane) {
  return span_along(patch.outline, plane).low < -side_tolerance;
}

// A pair while its rays are under way.
struct Trial {
  std::size_t pair = 0;
  std::array<double, 4> shift{};
  int clipped = -1;       // index of the pair's parts before each other's horizon, or -1: all of both
  int traced = 0;         // points of the sequence used
  int wanted = 0;         // to be used by the end of this round
  double weight = 0;      // of all rays
  double visible = 0;     // of those that arrive
  double squares = 0;     // of the weights
  std::int64_t rays = 0;  // cast

  double share() const { return weight > 0 ? visible / weight : 1; }
  // Never 0: rays that agree may all have missed a small part.
  double error() const {
    if (!(weight > 0)) return 0;
    const double count = weight * weight / squares;  // as many equal rays
    const double p = (share() * count + prior) / (count + 2 * prior);
    return error_constant * std::sqrt(p * (1 - p)) * std::pow(count, -error_order);
  }
};

}  // namespace

struct RayVisibility::Impl {
  Impl(const ClusterTree& cluster_tree, const OccluderSet& set, std::uint64_t stream)
      : tree(cluster_tree), seed(stream), occluders(set) {}

  const ClusterTree& tree;
  std::uint64_t seed;
  OccluderScene occluders;
};

namespace {

// Gathers rays of successive pairs and traces them sixteen at a time.
class Packet {
 public:
  Packet(RTCScene scene, std::vector<Trial>& trials) : scene_(scene), trials_(trials) {
    rtcInitIntersectContext(&context_);
    context_.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  }

  void add(std::size_t trial, const Vec3& from, const Vec3& to, double weight) {
    const Vec3 along = to - from;
    rays_.org_x[count_] = static_cast<float>(from.x());
    rays_.org_y[count_] = static_cast<float>(from.y());
    rays_.org_z[count_] = static_cast<float>(from.z());
    rays_.dir_x[count_] = static_cast<float>(along.x());
    rays_.dir_y[count_] = static_cast<float>(along.y());
    rays_.dir_z[count_] = static_cast<float>(along.z());
    rays_.tnear[count_] = 0;
    rays_.tfar[count_] = 1;
    rays_.time[count_] = 0;
    rays_.mask[count_] = ~0u;
    rays_.id[count_] = static_cast<unsigned>(count_);
    rays_.flags[count_] = 0;
    owner_[count_] = trial;
    weight_[count_] = weight;
    if (++count_ == packet) trace();
  }

  void trace() {
    if (count_ == 0) return;
    alignas(64) std::array<int, packet> valid{};
    for (int k = 0; k < count_; ++k) valid[k] = -1;
    rtcOccluded16(valid.data(), scene_, &context_, &rays_);
    for (int k = 0; k < count_; ++k) {
      Trial& trial = trials_[owner_[k]];
      trial.weight += weight_[k];
      trial.squares += weight_[k] * weight_[k];
      if (!(rays_.tfar[k] < 0)) trial.visible += weight_[k];
      ++trial.rays;
    }
    count_ = 0;
  }

 private:
  RTCScene scene_;
  std::vector<Trial>& trials_;
  RTCIntersectContext context_;
  alignas(64) RTCRay16 rays_;
  std::array<std::size_t, packet> owner_;
  std::array<double, packet> weight_;
  int count_ = 0;
};

}  // namespace

RayVisibility::RayVisibility(const ClusterTree& tree, const OccluderSet& set, std::uint64_t seed)
    : impl_(std::make_unique<Impl>(tree, set, seed)) {}

RayVisibility::~RayVisibility() = default;
RayVisibility::RayVisibility(RayVisibility&&) noexcept = default;

std::vector<RayShare> RayVisibility::visible(std::span<const RayPair> pairs) const {
  std::vector<Trial> trials(pairs.size());
  std::vector<std::size_t> open(pairs.size());
  std::vector<std::array<Polygon, 2>> clipped;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    open[k] = k;
    trials[k].pair = k;
    trials[k].wanted = first_rays;
    const auto i = static_cast<std::uint64_t>(impl_->tree.patches[pairs[k].s].patch);
    const auto j = static_cast<std::uint64_t>(impl_->tree.patches[pairs[k].t].patch);
    std::uint64_t state = mixed(impl_->seed ^ mixed(i << 32 | j));
    const WorkPatch &a = impl_->tree.patches[pairs[k].s], &b = impl_->tree.patches[pairs[k].t];
    if (straddles(a, b.plane) || straddles(b, a.plane)) {
      const Polygon from = clip(a.outline, b.plane, side_tolerance),
                    to = clip(b.outline, a.plane, side_tolerance);
      if (from.count >= 3 && to.count >= 3) {
        trials[k].clipped = static_cast<int>(clipped.size());
        clipped.push_back({from, to});
      }
    }
    for (double& shift : trials[k].shift) shift = unit(state = mixed(state));
  }
  Packet packet_of_rays(impl_->occluders.scene(), trials);
  while (!open.empty()) {
    for (std::size_t k : open) {
      Trial& trial = trials[k];
      const WorkPatch &a = impl_->tree.patches[pairs[k].s], &b = impl_->tree.patches[pairs[k].t];
      const Polygon& from_part =
          trial.clipped < 0 ? a.outline : clipped[static_cast<std::size_t>(trial.clipped)][0];
      const Polygon& to_part =
          trial.clipped < 0 ? b.outline : clipped[static_cast<std::size_t>(trial.clipped)][1];
      for (; trial.traced < trial.wanted; ++trial.traced) {
        std::array<double, 4> u;
        for (std::size_t c = 0; c < 4; ++c) {
          const double x = trial.shift[c] + trial.traced * recurrence[c];
          u[c] = x - std::floor(x);
        }
        const PatchPoint x = point_on(from_part, u[0], u[1]), y = point_on(to_part, u[2], u[3]);
        const Vec3 sight = y.at - x.at;
        const double from = sight.dot(a.plane.normal), to = -sight.dot(b.plane.normal);
        if (from <= 0 || to <= 0) continue;
        const double squared = sight.squaredNorm();
        packet_of_rays.add(k, x.at + surface_offset * a.plane.normal, y.at + surface_offset * b.plane.normal,
                           from * to / (squared * squared) * x.stretch * y.stretch);
      }
    }
    packet_of_rays.trace();
    std::erase_if(open, [&](std::size_t k) {
      return trials[k].wanted >= most_rays || trials[k].error() * pairs[k].unhidden <= pairs[k].tolerance;
    });
    for (std::size_t k : open) trials[k].wanted *= 2;
  }
  std::vector<RayShare> shares(pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    shares[k] = {trials[k].share(), trials[k].error(), trials[k].rays};
  }
  return shares;
}

}  // namespace luxel
