#include "luxel/ray_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "rays/embree_triangles.h"

namespace luxel {

namespace {

// A ray that meets no front is asked again this far aside, in working units: wide enough to step over what
// float rounding can open at a shared edge or move of an origin beside one, below every feature of 1e-6.
constexpr double second_look = 5e-7;

// Then it starts this far before its origin, in working units, so that a surface is met that stands so close
// to the origin, or leans so flat over it, that float cannot tell on which side of it the origin lies.
constexpr double second_run_up = 1e-3;

// Ways aside: at 120 degrees, one of them leads away from any edge nearby.
constexpr int ways_aside = 3;

/// The ends of one ray, in working coordinates.
struct Ray {
  Vec3 origin, normal, direction;
};

/// How far a ray first goes from an origin outside of the scene (a camera), to where float is precise: to the
/// ball of radius 2 around the scene.
double approach(const Vec3& origin, const Vec3& direction) {
  constexpr double radius = 2;
  return origin.squaredNorm() > radius * radius ? std::max(0.0, -origin.dot(direction) - radius) : 0.0;
}

/// Front before back before nothing, then the nearer.
bool better(const RayScene::Hit& a, const RayScene::Hit& b) {
  const auto rank = [](const RayScene::Hit& hit) { return hit.front ? 2 : hit.primitive >= 0 ? 1 : 0; };
  return rank(a) != rank(b) ? rank(a) > rank(b) : a.distance < b.distance;
}

}  // namespace

struct RayScene::Impl {
  EmbreeTriangles triangles;
  std::vector<int> names;  // primitive by triangle; empty: the same numbers, and no triangles back to back

  Impl(const std::vector<Vec3>& vertices, const std::vector<std::array<int, 3>>& corners,
       std::vector<int> names_)
      : triangles(vertices, corners, !names_.empty()), names(std::move(names_)) {}

  void look_again(std::span<const Ray> rays, std::span<Hit* const> hits) const;
};

/// Puts what rays a hair aside say in the place of hits that met no front: the nearest front that any of them
/// meets, else the nearest back. As many rays as fit one packet.
void RayScene::Impl::look_again(std::span<const Ray> rays, std::span<Hit* const> hits) const {
  constexpr int size = EmbreeTriangles::packet_size;
  std::array<Vec3, size> origins, starts, normals, directions;
  std::array<Hit, size> aside_hits;
  std::size_t count = 0;
  const double aside = std::max(second_look, 2 * triangles.offset());
  for (const Ray& ray : rays) {
    const Vec3 tangent = ray.normal.unitOrthogonal(), bitangent = ray.normal.cross(tangent);
    const double start = approach(ray.origin, ray.direction) - second_run_up;
    for (int way = 0; way < ways_aside; ++way, ++count) {
      constexpr std::array<double, ways_aside> cosine{1, -0.5, -0.5},
          sine{0, 0.8660254037844386, -0.8660254037844386};
      origins[count] = ray.origin + aside * (cosine[way] * tangent + sine[way] * bitangent);
      starts[count] = origins[count] + start * ray.direction;
      normals[count] = ray.normal;
      directions[count] = ray.direction;
    }
  }
  triangles.trace({origins.data(), count}, {starts.data(), count}, {normals.data(), count},
                  {directions.data(), count}, {aside_hits.data(), count});
  for (std::size_t k = 0; k < count; ++k) {
    Hit& hit = *hits[k / ways_aside];
    if (better(aside_hits[k], hit)) hit = aside_hits[k];
  }
}

RayScene::RayScene(const Occluders& occluders)
    : impl_(std::make_unique<Impl>(occluders.vertices, occluders.triangles, std::vector<int>())) {}

RayScene::RayScene(const PatchMesh& mesh) {
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> names;
  triangles.reserve(mesh.corners.size());
  names.reserve(mesh.corners.size());
  for (int i = 0; i < mesh.size(); ++i) {
    const auto& c = mesh.corners[i];
    triangles.push_back({c[0], c[1], c[2]});
    names.push_back(i);
    if (c[3] >= 0) {
      triangles.push_back({c[0], c[2], c[3]});
      names.push_back(i | second_half);
    }
  }
  impl_ = std::make_unique<Impl>(mesh.vertices, triangles, std::move(names));
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

void RayScene::intersect(std::span<const Vec3> origins, std::span<const Vec3> normals,
                         std::span<const Vec3> directions, std::span<Hit> hits, Look look) const {
  if (normals.size() != origins.size() || directions.size() != origins.size() ||
      hits.size() != origins.size()) {
    throw std::invalid_argument(
        "RayScene::intersect: origins, normals, directions and hits differ in number");
  }
  constexpr std::size_t packet_size = EmbreeTriangles::packet_size;
  const EmbreeTriangles& triangles = impl_->triangles;
  const bool with_twins = !impl_->names.empty();

  // rays that met no front, until they fill a packet of second looks
  constexpr std::size_t most_doubtful = packet_size / ways_aside;
  std::array<Ray, most_doubtful> doubtful;
  std::array<Hit*, most_doubtful> doubtful_hits;
  std::size_t doubts = 0;
  const auto look_again = [&] {
    impl_->look_again({doubtful.data(), doubts}, {doubtful_hits.data(), doubts});
    doubts = 0;
  };

  std::array<Vec3, packet_size> local, starts;
  for (std::size_t begin = 0; begin < origins.size(); begin += packet_size) {
    const std::size_t count = std::min(packet_size, origins.size() - begin);
    for (std::size_t k = 0; k < count; ++k) {
      local[k] = triangles.working(origins[begin + k]);
      starts[k] = local[k] + triangles.offset() * normals[begin + k] +
                  approach(local[k], directions[begin + k]) * directions[begin + k];
    }
    triangles.trace({local.data(), count}, {starts.data(), count}, normals.subspan(begin, count),
                    directions.subspan(begin, count), hits.subspan(begin, count));
    for (std::size_t k = 0; k < count; ++k) {
      Hit& hit = hits[begin + k];
      if (hit.front) continue;
      if (with_twins && hit.primitive >= 0) {
        hit = triangles.facing_twin(local[k], normals[begin + k], directions[begin + k], hit);
      }
      if (look == Look::once || hit.front) continue;
      doubtful[doubts] = {local[k], normals[begin + k], directions[begin + k]};
      doubtful_hits[doubts] = &hit;
      if (++doubts == most_doubtful) look_again();
    }
  }
  if (doubts > 0) look_again();
  for (Hit& hit : hits) {
    hit.distance /= triangles.scale();
    if (hit.primitive >= 0 && with_twins) hit.primitive = impl_->names[hit.primitive];
  }
}

void* RayScene::embree_scene() const {
  return impl_->triangles.scene();
}
const Vec3& RayScene::centre() const {
  return impl_->triangles.centre();
}
double RayScene::scale() const {
  return impl_->triangles.scale();
}

}  // namespace luxel
