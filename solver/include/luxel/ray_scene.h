#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "luxel/patch_mesh.h"

namespace luxel {

/// Rays against triangles (Embree), in coordinates centred and scaled to the scene, so that neither its size
/// nor its distance from the origin costs digits. Both sides of a triangle block. Immutable and safe from
/// many threads.
class RayScene {
 public:
  struct Hit {
    int primitive = -1;   ///< the triangle, or -1: the ray escapes
    double distance = 0;  ///< along the unit direction [m]
    bool front = false;   ///< the front side was met
    float u = 0, v = 0;   ///< barycentric coordinates of the second and the third corner
  };

  /// Rays against the merged polygons: primitive = index into occluders.triangles.
  explicit RayScene(const Occluders& occluders);
  /// Rays against the patches: primitive = patch; a quad's second triangle (corners 0, 2, 3) has bit 30 set.
  explicit RayScene(const PatchMesh& mesh);
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  static constexpr int second_half = 1 << 30;

  /// How a ray that meets no front is treated. Float rounds at 6e-8 of the scene, so that beside an edge, or
  /// along a crack of that width, a ray may slip through.
  enum class Look {
    once,  ///< taken as it is
    twice  ///< asked again from 5e-7 of the diagonal aside, three ways: a closed body never leaks, and
           ///< openings narrower than that are not seen
  };

  /// Nearest hits of rays that start at `origins` (a hair off the surface is the callee's business: each
  /// origin comes with the unit normal of the surface that it lies on) along unit `directions`; the four
  /// spans have one length. Triangles in the plane of an origin and parallel to it are never met.
  /// @throws std::invalid_argument if the lengths differ
  void intersect(std::span<const Vec3> origins, std::span<const Vec3> normals,
                 std::span<const Vec3> directions, std::span<Hit> hits, Look look = Look::twice) const;

  /// The Embree scene (RTCScene) and the map to its coordinates, x' = (x - centre) * scale, for kernels of
  /// the solver that build their own packets.
  void* embree_scene() const;
  const Vec3& centre() const;
  double scale() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace luxel
