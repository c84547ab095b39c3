#include <cmath>
#include <sstream>

#include "luxel/input_error.h"
#include "luxel/scene.h"

namespace luxel {

namespace {

// Largest coordinate that can be used [m]: the fourth power of a length, which squared areas need, stays
// finite.
constexpr double largest_coordinate = 1e75;

template <class... Parts>
[[noreturn]] void fail(const Scene& scene, const Parts&... parts) {
  std::ostringstream message;
  if (!scene.file.empty()) message << scene.file << ": ";
  (message << ... << parts);
  throw InputError(message.str());
}

void check_vertices(const Scene& scene) {
  for (std::size_t v = 0; v < scene.vertices.size(); ++v) {
    for (const double x : scene.vertices[v]) {
      if (!std::isfinite(x)) fail(scene, "vertex ", v, ": coordinate ", x, ", expected a finite number");
      if (std::abs(x) > largest_coordinate) {
        fail(scene, "vertex ", v, ": coordinate ", x, ", expected at most ", largest_coordinate);
      }
    }
  }
}

void check_faces(const Scene& scene) {
  const auto& offsets = scene.face_offsets;
  if (offsets.empty() || offsets.front() != 0) fail(scene, "face offsets: expected to start with 0");
  for (int f = 0; f < scene.face_count(); ++f) {
    if (offsets[f + 1] < offsets[f]) {
      fail(scene, "face ", f, ": ends at corner ", offsets[f + 1], " but starts at ", offsets[f]);
    }
  }
  if (offsets.back() != static_cast<int>(scene.face_vertices.size())) {
    fail(scene, "face offsets: end with ", offsets.back(), ", expected the number of corners, ",
         scene.face_vertices.size());
  }
  const int vertex_count = static_cast<int>(scene.vertices.size());
  for (int f = 0; f < scene.face_count(); ++f) {
    for (int c = offsets[f]; c < offsets[f + 1]; ++c) {
      const int v = scene.face_vertices[c];
      if (v < 0 || v >= vertex_count) {
        fail(scene, "face ", f, ": corner ", c - offsets[f], " is vertex ", v, ", expected 0 to ",
             vertex_count - 1);
      }
    }
  }
}

void check_attribute(const Scene& scene, const std::vector<int>& values, std::size_t count,
                     const char* name) {
  if (static_cast<int>(values.size()) != scene.face_count()) {
    fail(scene, "faces have ", values.size(), " ", name, " indices, expected ", scene.face_count());
  }
  for (int f = 0; f < scene.face_count(); ++f) {
    if (values[f] < 0 || values[f] >= static_cast<int>(count)) {
      fail(scene, "face ", f, ": ", name, " ", values[f], ", expected 0 to ", static_cast<long>(count) - 1);
    }
  }
}

void check_finishes(const Scene& scene) {
  for (std::size_t i = 0; i < scene.finishes.size(); ++i) {
    for (const double rho : scene.finishes[i].reflectance) {
      if (!(rho >= 0 && rho <= 1)) fail(scene, "finish ", i, ": reflectance ", rho, ", expected 0 to 1");
    }
    for (const double e : scene.finishes[i].emission) {
      if (!(e >= 0 && std::isfinite(e))) {
        fail(scene, "finish ", i, ": emission ", e, " W/m2, expected a finite number >= 0");
      }
    }
  }
}

void check_camera(const Scene& scene) {
  if (!scene.camera) return;
  const Camera& camera = *scene.camera;
  if (!camera.eye.allFinite() || !camera.target.allFinite() || !camera.up.allFinite()) {
    fail(scene, "camera: eye, target or up is not finite");
  }
  if (!(camera.fov > 0 && camera.fov < 180)) {
    fail(scene, "camera: fov ", camera.fov, ", expected between 0 and 180 degrees");
  }
  if (camera.width < 1 || camera.height < 1) {
    fail(scene, "camera: ", camera.width, " x ", camera.height, " pixels, expected at least 1 x 1");
  }
}

}  // namespace

void validate(const Scene& scene) {
  check_vertices(scene);
  check_faces(scene);
  check_attribute(scene, scene.face_groups, scene.groups.size(), "group");
  check_attribute(scene, scene.face_materials, scene.materials.size(), "material");
  check_attribute(scene, scene.face_finishes, scene.finishes.size(), "finish");
  check_finishes(scene);
  check_camera(scene);
}

}  // namespace luxel
