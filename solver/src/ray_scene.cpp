#include "luxel/ray_scene.h"

#include <embree3/rtcore.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <new>
#include <stdexcept>
#include <utility>
#include <vector>

namespace luxel {

namespace {

// Rays start this far off their surface, in working units (the diagonal lies in [1, 2)): above the rounding
// of an origin and of a triangle in float, 5e-8 each, and well below gaps of 1e-6 of the diagonal.
constexpr double surface_offset = 2e-7;

// A ray that meets no front is asked again this far aside, in working units: wide enough to step over what
// float rounding can open at a shared edge or move of an origin beside one, below every feature of 1e-6.
constexpr double second_look = 5e-7;

// Then it starts this far before its origin, in working units, so that a surface is met that stands so close
// to the origin, or leans so flat over it, that float cannot tell on which side of it the origin lies.
constexpr double second_run_up = 1e-3;

// Triangles more parallel than this [cosine] to the surface of an origin in their plane are that surface.
constexpr double parallel = 1 - 1e-6;

// Times that one ray may be sent on after a hit that double precision refutes.
constexpr int max_refuted_hits = 16;

constexpr int packet_size = 16;

struct TrianglePlane {
  Vec3 normal;  // unit, front
  double offset;
};

/// A context whose filter lets only the fronts of triangles through.
struct FrontsOnly : RTCIntersectContext {
  const std::vector<TrianglePlane>* planes;
  Vec3 direction;

  static void fronts(const RTCFilterFunctionNArguments* call) {
    const auto* self = static_cast<const FrontsOnly*>(call->context);
    for (unsigned k = 0; k < call->N; ++k) {
      const TrianglePlane& plane = (*self->planes)[RTCHitN_primID(call->hit, call->N, k)];
      if (plane.normal.dot(self->direction) >= 0) call->valid[k] = 0;
    }
  }
};

}  // namespace

struct RayScene::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  Vec3 centre = Vec3::Zero();
  double scale = 1;
  double offset = surface_offset;  // working units
  double rounding = 1e-13;         // of the input's coordinates, working units
  std::vector<TrianglePlane> planes;
  std::vector<int> names;  // primitive by triangle; empty: the same numbers

  Impl(const std::vector<Vec3>& vertices, const std::vector<std::array<int, 3>>& triangles, int flags);
  ~Impl() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void frame(const std::vector<Vec3>& vertices);
  /// Nearest hits of up to packet_size rays, in working coordinates (distances too).
  void trace(const Vec3* origins, const Vec3* starts, const Vec3* normals, const Vec3* directions, Hit* hits,
             int count) const;
  Hit facing_twin(const Vec3& origin, const Vec3& normal, const Vec3& direction, const Hit& back) const;
  Hit second_opinion(const Vec3& origin, const Vec3& normal, const Vec3& direction, const Hit& first) const;
};

/// Centre and power-of-two scale that bring the diagonal of the vertices' box into [1, 2).
void RayScene::Impl::frame(const std::vector<Vec3>& vertices) {
  if (vertices.empty()) return;
  Vec3 low = vertices[0], high = vertices[0];
  double largest = 0;
  for (const Vec3& x : vertices) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
    largest = std::max(largest, x.cwiseAbs().maxCoeff());
  }
  centre = low + (high - low) / 2;
  const double diagonal = (high - low).norm();
  if (diagonal > 0) scale = std::ldexp(1.0, -std::ilogb(diagonal));
  // eight roundings of the input's largest coordinate: what a far origin costs the planes
  rounding = 1e-13 + 8 * std::numeric_limits<double>::epsilon() * largest * scale;
  offset = std::max(surface_offset, 4 * rounding);
}

RayScene::Impl::Impl(const std::vector<Vec3>& vertices, const std::vector<std::array<int, 3>>& triangles,
                     int flags) {
  frame(vertices);
  device = rtcNewDevice(nullptr);
  if (!device)
    throw std::runtime_error("Embree cannot start: error " + std::to_string(rtcGetDeviceError(nullptr)));
  scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | flags));
  if (!triangles.empty()) {
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), vertices.size()));
    auto* corners = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), triangles.size()));
    if (!points || !corners) throw std::bad_alloc();
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      const Vec3 x = (vertices[v] - centre) * scale;
      for (int k = 0; k < 3; ++k) points[3 * v + k] = static_cast<float>(x[k]);
    }
    planes.reserve(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      std::array<Vec3, 3> x;
      for (int k = 0; k < 3; ++k) {
        corners[3 * t + k] = static_cast<unsigned>(triangles[t][k]);
        x[k] = (vertices[triangles[t][k]] - centre) * scale;
      }
      const Vec3 normal = (x[1] - x[0]).cross(x[2] - x[0]).stableNormalized();
      planes.push_back({normal, normal.dot((x[0] + x[1] + x[2]) / 3)});
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(scene);
}

/// Nearest hits of up to packet_size rays, in working coordinates (distances too). Embree proposes, in float;
/// the side and the distance come from the triangle's plane in double, and a hit on the origin's own surface
/// or behind it is refuted: the ray goes on from there.
void RayScene::Impl::trace(const Vec3* origins, const Vec3* starts, const Vec3* normals,
                           const Vec3* directions, Hit* hits, int count) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit16 packet;
  alignas(64) std::array<int, packet_size> active{};
  for (int k = 0; k < packet_size; ++k) {
    const int from = std::min(k, count - 1);
    active[k] = k < count ? -1 : 0;
    const Vec3& d = directions[from];
    const Vec3& start = starts[from];
    packet.ray.org_x[k] = static_cast<float>(start[0]);
    packet.ray.org_y[k] = static_cast<float>(start[1]);
    packet.ray.org_z[k] = static_cast<float>(start[2]);
    packet.ray.dir_x[k] = static_cast<float>(d[0]);
    packet.ray.dir_y[k] = static_cast<float>(d[1]);
    packet.ray.dir_z[k] = static_cast<float>(d[2]);
    packet.ray.tnear[k] = 0;
    packet.ray.tfar[k] = std::numeric_limits<float>::infinity();
    packet.ray.time[k] = 0;
    packet.ray.mask[k] = ~0u;
    packet.ray.id[k] = 0;
    packet.ray.flags[k] = 0;
    packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
  }
  for (int round = 0; round < max_refuted_hits; ++round) {
    rtcIntersect16(active.data(), scene, &context, &packet);
    bool refuted = false;
    for (int k = 0; k < count; ++k) {
      if (!active[k]) continue;
      active[k] = 0;
      hits[k] = Hit();
      if (packet.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID) continue;
      const int triangle = static_cast<int>(packet.hit.primID[k]);
      const TrianglePlane& plane = planes[triangle];
      const double height = plane.normal.dot(origins[k]) - plane.offset;
      const double slope = plane.normal.dot(directions[k]);
      const bool own = std::abs(height) <= rounding && std::abs(plane.normal.dot(normals[k])) >= parallel;
      const double distance = slope != 0 ? -height / slope : packet.ray.tfar[k];
      // behind: by more than the rounding, measured at right angles to the triangle
      const bool behind = distance < 0 && std::abs(height) > rounding;
      if (own || behind) {
        active[k] = -1;
        refuted = true;
        packet.ray.tnear[k] = std::nextafter(packet.ray.tfar[k], std::numeric_limits<float>::infinity());
        packet.ray.tfar[k] = std::numeric_limits<float>::infinity();
        packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
        continue;
      }
      hits[k] = {triangle, std::max(distance, 0.0), slope < 0, packet.hit.u[k], packet.hit.v[k]};
    }
    if (!refuted) return;
  }
}

/// Where two sheets lie back to back Embree may report either: the front in the place of a `back` that was
/// met, or else that back.
RayScene::Hit RayScene::Impl::facing_twin(const Vec3& origin, const Vec3& normal, const Vec3& direction,
                                          const Hit& back) const {
  FrontsOnly context;
  rtcInitIntersectContext(&context);
  context.filter = &FrontsOnly::fronts;
  context.planes = &planes;
  context.direction = direction;
  // from close by, so that both sheets are met at the precision of the scene
  const double reach = 2 * offset;
  const double before = std::max(0.0, back.distance - 4 * reach);
  const Vec3 start = origin + offset * normal + before * direction;
  RTCRayHit ray{};
  ray.ray.org_x = static_cast<float>(start[0]);
  ray.ray.org_y = static_cast<float>(start[1]);
  ray.ray.org_z = static_cast<float>(start[2]);
  ray.ray.dir_x = static_cast<float>(direction[0]);
  ray.ray.dir_y = static_cast<float>(direction[1]);
  ray.ray.dir_z = static_cast<float>(direction[2]);
  const double slope = std::abs(planes[back.primitive].normal.dot(direction));
  ray.ray.tfar = static_cast<float>(8 * reach + reach / std::max(slope, 1e-3));
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene, &context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return back;
  const int triangle = static_cast<int>(ray.hit.primID);
  const Vec3 met = origin + back.distance * direction;
  if (std::abs(planes[triangle].normal.dot(met) - planes[triangle].offset) > reach) return back;
  return {triangle, back.distance, true, ray.hit.u, ray.hit.v};
}

/// What rays a hair aside say of one that met no front: the nearest front that any of them meets, else
/// `first`.
RayScene::Hit RayScene::Impl::second_opinion(const Vec3& origin, const Vec3& normal, const Vec3& direction,
                                             const Hit& first) const {
  const Vec3 tangent = normal.unitOrthogonal();
  const Vec3 bitangent = normal.cross(tangent);
  const double aside = std::max(second_look, 2 * offset);
  const double sine = std::sqrt(0.75);
  const std::array<Vec3, 3> origins{origin + aside * tangent,
                                    origin + aside * (-0.5 * tangent + sine * bitangent),
                                    origin + aside * (-0.5 * tangent - sine * bitangent)};
  std::array<Vec3, 3> starts;
  for (int k = 0; k < 3; ++k) starts[k] = origins[k] - second_run_up * direction;
  const std::array<Vec3, 3> normals{normal, normal, normal};
  const std::array<Vec3, 3> directions{direction, direction, direction};
  std::array<Hit, 3> hits;
  trace(origins.data(), starts.data(), normals.data(), directions.data(), hits.data(), 3);
  const auto rank = [](const Hit& hit) { return hit.front ? 2 : hit.primitive >= 0 ? 1 : 0; };
  Hit best = first;
  for (const Hit& hit : hits) {
    if (rank(hit) > rank(best) || (rank(hit) == rank(best) && hit.distance < best.distance)) best = hit;
  }
  return best;
}

RayScene::RayScene(const Occluders& occluders)
    : impl_(std::make_unique<Impl>(occluders.vertices, occluders.triangles, RTC_SCENE_FLAG_NONE)) {}

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
  impl_ = std::make_unique<Impl>(mesh.vertices, triangles, RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
  impl_->names = std::move(names);
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
  std::array<Vec3, packet_size> local, starts;
  for (std::size_t begin = 0; begin < origins.size(); begin += packet_size) {
    const int count = static_cast<int>(std::min<std::size_t>(packet_size, origins.size() - begin));
    for (int k = 0; k < count; ++k) {
      local[k] = (origins[begin + k] - impl_->centre) * impl_->scale;
      // an origin outside the scene (a camera) first goes to the sphere around it, where float is precise
      const Vec3& d = directions[begin + k];
      const double outside = local[k].squaredNorm() > 4 ? std::max(0.0, -local[k].dot(d) - 2) : 0;
      starts[k] = local[k] + impl_->offset * normals[begin + k] + outside * d;
    }
    impl_->trace(local.data(), starts.data(), &normals[begin], &directions[begin], &hits[begin], count);
    for (int k = 0; k < count; ++k) {
      Hit& hit = hits[begin + k];
      // merged polygons stand once for coincident sheets; patches do not
      if (!impl_->names.empty() && !hit.front && hit.primitive >= 0) {
        hit = impl_->facing_twin(local[k], normals[begin + k], directions[begin + k], hit);
      }
      if (look == Look::twice && !hit.front)
        hit = impl_->second_opinion(local[k], normals[begin + k], directions[begin + k], hit);
      hit.distance /= impl_->scale;
      if (hit.primitive >= 0 && !impl_->names.empty()) hit.primitive = impl_->names[hit.primitive];
    }
  }
}

void* RayScene::embree_scene() const {
  return impl_->scene;
}
const Vec3& RayScene::centre() const {
  return impl_->centre;
}
double RayScene::scale() const {
  return impl_->scale;
}

}  // namespace luxel
