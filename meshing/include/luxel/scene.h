#pragma once

#include <optional>
#include <string>
#include <vector>

#include "luxel/vector.h"

namespace luxel {

/// How a surface reflects and emits, per channel.
struct Finish {
  Rgb reflectance = Rgb::Constant(0.5);  ///< diffuse reflectance rho, each channel in [0, 1]
  Rgb emission = Rgb::Zero();            ///< self-emitted exitance E [W/m2], each channel finite and >= 0
  bool two_sided = false;                ///< gives two patches back to back; else the back is black

  bool operator==(const Finish& other) const {
    return (reflectance == other.reflectance).all() && (emission == other.emission).all() &&
           two_sided == other.two_sided;
  }
};

/// A perspective view.
struct Camera {
  Vec3 eye = Vec3(0, 0, 5);
  Vec3 target = Vec3(0, 0, 0);
  Vec3 up = Vec3(0, 1, 0);
  double fov = 40;   ///< vertical field of view [degrees], in (0, 180)
  int width = 800;   ///< [pixels], >= 1
  int height = 600;  ///< [pixels], >= 1
};

/// A mesh with its surface properties, as the user described it: an indexed polygon soup. Faces may be
/// non-manifold, concave, non-planar, degenerate or duplicated; mesh_scene() deals with all that. Every
/// number is finite, every index in range, every reflectance in [0, 1]: the readers of io/ guarantee it, and
/// validate() checks it for anyone else.
struct Scene {
  std::string file;            ///< where it came from, for messages and reports
  std::vector<Vec3> vertices;  ///< [m]
  std::vector<int> face_offsets{
      0};  ///< F + 1 entries: face f has corners face_vertices[offsets[f] .. offsets[f+1])
  std::vector<int> face_vertices;      ///< counter-clockwise seen from the front
  std::vector<int> face_groups;        ///< F indices into `groups`
  std::vector<int> face_materials;     ///< F indices into `materials`
  std::vector<int> face_finishes;      ///< F indices into `finishes`
  std::vector<std::string> groups;     ///< names, in order of first use
  std::vector<std::string> materials;  ///< names, in order of first use
  std::vector<Finish> finishes;        ///< what materials and surfaces resolve to
  std::optional<Camera> camera;
  std::vector<std::string> warnings;  ///< one sentence each, for the report

  int face_count() const { return static_cast<int>(face_offsets.size()) - 1; }
};

/// @throws InputError naming scene.file and the first face, vertex or finish that breaks what Scene promises.
void validate(const Scene& scene);

}  // namespace luxel
