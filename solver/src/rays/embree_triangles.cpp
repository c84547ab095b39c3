#include "rays/embree_triangles.h"

#include <embree3/rtcore.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>

namespace luxel {

namespace {

// Rays start this far off their surface, in working units: above the rounding of an origin and of a triangle
// in float, 5e-8 each, and well below gaps of 1e-6 of the diagonal.
constexpr double surface_offset = 2e-7;

// Triangles more parallel than this [cosine] to the surface of an origin in their plane are that surface.
constexpr double parallel = 1 - 1e-6;

// Triangles from which rays wait for memory.
constexpr std::size_t large_scene = 100'000;

// Times that one ray may be sent on after a hit that double precision refutes.
constexpr int max_refuted_hits = 16;

}  // namespace

/// Centre and power-of-two scale_ that bring the diagonal of the vertices' box into [1, 2).
void EmbreeTriangles::find_frame(const std::vector<Vec3>& vertices) {
  if (vertices.empty()) return;
  Vec3 low = vertices[0], high = vertices[0];
  double largest = 0;
  for (const Vec3& x : vertices) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
    largest = std::max(largest, x.cwiseAbs().maxCoeff());
  }
  centre_ = low + (high - low) / 2;
  const double diagonal = (high - low).norm();
  if (diagonal > 0) scale_ = std::ldexp(1.0, -std::ilogb(diagonal));
  // eight roundings of the input's largest coordinate: what a far origin costs the planes_
  rounding_ = 1e-13 + 8 * std::numeric_limits<double>::epsilon() * largest * scale_;
  offset_ = std::max(surface_offset, 4 * rounding_);
}

EmbreeTriangles::EmbreeTriangles(const std::vector<Vec3>& vertices,
                                 const std::vector<std::array<int, 3>>& triangles, bool with_twins) {
  find_frame(vertices);
  device_ = rtcNewDevice(nullptr);
  if (!device_)
    throw std::runtime_error("Embree cannot start: error " + std::to_string(rtcGetDeviceError(nullptr)));
  scene_ = rtcNewScene(device_);
  rtcSetSceneFlags(scene_, with_twins ? RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION
                                      : RTC_SCENE_FLAG_ROBUST);
  // spatial splits: a third more rays a second in a large scene, for twice the time to build
  if (triangles.size() > large_scene) rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
  if (!triangles.empty()) {
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), vertices.size()));
    auto* corners = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), triangles.size()));
    if (!points || !corners) throw std::bad_alloc();
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      const Vec3 x = (vertices[v] - centre_) * scale_;
      for (int k = 0; k < 3; ++k) points[3 * v + k] = static_cast<float>(x[k]);
    }
    planes_.reserve(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      std::array<Vec3, 3> x;
      for (int k = 0; k < 3; ++k) {
        corners[3 * t + k] = static_cast<unsigned>(triangles[t][k]);
        x[k] = (vertices[triangles[t][k]] - centre_) * scale_;
      }
      const Vec3 normal = (x[1] - x[0]).cross(x[2] - x[0]).stableNormalized();
      planes_.push_back({normal, normal.dot((x[0] + x[1] + x[2]) / 3)});
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(scene_);
}

EmbreeTriangles::~EmbreeTriangles() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

void EmbreeTriangles::trace(std::span<const Vec3> origins, std::span<const Vec3> starts,
                            std::span<const Vec3> normals, std::span<const Vec3> directions,
                            std::span<Hit> hits) const {
  const int count = static_cast<int>(origins.size());
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
    rtcIntersect16(active.data(), scene_, &context, &packet);
    bool refuted = false;
    for (int k = 0; k < count; ++k) {
      if (!active[k]) continue;
      active[k] = 0;
      hits[k] = Hit();
      if (packet.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID) continue;
      const int triangle = static_cast<int>(packet.hit.primID[k]);
      const Plane& plane = planes_[triangle];
      const double height = plane.normal.dot(origins[k]) - plane.offset;
      const double slope = plane.normal.dot(directions[k]);
      const bool own = std::abs(height) <= rounding_ && std::abs(plane.normal.dot(normals[k])) >= parallel;
      const double distance = slope != 0 ? -height / slope : packet.ray.tfar[k];
      // behind: by more than the rounding_, measured at right angles to the triangle
      const bool behind = distance < 0 && std::abs(height) > rounding_;
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

/// A context whose filter lets only the fronts of triangles through.
struct EmbreeTriangles::FrontsOnly : RTCIntersectContext {
  const std::vector<Plane>* planes;
  Vec3 direction;

  static void fronts(const RTCFilterFunctionNArguments* call) {
    const auto* self = static_cast<const FrontsOnly*>(call->context);
    for (unsigned k = 0; k < call->N; ++k) {
      const Plane& plane = (*self->planes)[RTCHitN_primID(call->hit, call->N, k)];
      if (plane.normal.dot(self->direction) >= 0) call->valid[k] = 0;
    }
  }
};

EmbreeTriangles::Hit EmbreeTriangles::facing_twin(const Vec3& origin, const Vec3& normal,
                                                  const Vec3& direction, const Hit& back) const {
  FrontsOnly context;
  rtcInitIntersectContext(&context);
  context.filter = &FrontsOnly::fronts;
  context.planes = &planes_;
  context.direction = direction;
  // from close by, so that both sheets are met at the precision of the scene_
  const double reach = 2 * offset_;
  const double before = std::max(0.0, back.distance - 4 * reach);
  const Vec3 start = origin + offset_ * normal + before * direction;
  RTCRayHit ray{};
  ray.ray.org_x = static_cast<float>(start[0]);
  ray.ray.org_y = static_cast<float>(start[1]);
  ray.ray.org_z = static_cast<float>(start[2]);
  ray.ray.dir_x = static_cast<float>(direction[0]);
  ray.ray.dir_y = static_cast<float>(direction[1]);
  ray.ray.dir_z = static_cast<float>(direction[2]);
  const double slope = std::abs(planes_[back.primitive].normal.dot(direction));
  ray.ray.tfar = static_cast<float>(8 * reach + reach / std::max(slope, 1e-3));
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_, &context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return back;
  const int triangle = static_cast<int>(ray.hit.primID);
  const Vec3 met = origin + back.distance * direction;
  if (std::abs(planes_[triangle].normal.dot(met) - planes_[triangle].offset) > reach) return back;
  return {triangle, back.distance, true, ray.hit.u, ray.hit.v};
}

}  // namespace luxel
