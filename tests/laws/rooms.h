#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "luxel/dense_operator.h"
#include "luxel/enclosures.h"
#include "luxel/form_factors.h"
#include "luxel/mesh_scene.h"
#include "luxel/scene.h"
#include "luxel/solve.h"

// Rooms made in the tests, and the whole road from one of them to its light.
namespace luxel::testing {

/// A scene of boxes; each side is a group and has a finish of its own, or is left open.
class Room {
 public:
  using Sides = std::array<std::optional<Finish>, 6>;  // low z, high z, low y, high y, low x, high x

  Room& box(const Vec3& low, const Vec3& high, bool inside, const Sides& sides) {
    constexpr std::array<std::array<int, 4>, 6> outward{
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    const int first = static_cast<int>(scene_.vertices.size());
    for (int k = 0; k < 8; ++k) {
      scene_.vertices.emplace_back(k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1],
                                   k & 4 ? high[2] : low[2]);
    }
    for (int side = 0; side < 6; ++side) {
      if (!sides[side]) continue;
      std::array<int, 4> corners = outward[side];
      if (inside) std::swap(corners[1], corners[3]);
      for (const int corner : corners) scene_.face_vertices.push_back(first + corner);
      scene_.face_offsets.push_back(static_cast<int>(scene_.face_vertices.size()));
      scene_.face_groups.push_back(static_cast<int>(scene_.groups.size()));
      scene_.face_materials.push_back(0);
      scene_.face_finishes.push_back(static_cast<int>(scene_.finishes.size()));
      scene_.groups.push_back("side" + std::to_string(scene_.groups.size()));
      scene_.finishes.push_back(*sides[side]);
    }
    return *this;
  }

  Room& box(const Vec3& low, const Vec3& high, bool inside, const Finish& finish) {
    return box(low, high, inside, {finish, finish, finish, finish, finish, finish});
  }

  Scene scene() const {
    Scene scene = scene_;
    scene.file = "room";
    scene.materials = {"default"};
    return scene;
  }

 private:
  Scene scene_;
};

inline Finish finish(double reflectance, double emission = 0) {
  return {Rgb::Constant(reflectance), Rgb::Constant(emission), false};
}

/// A room of 4 x 3 x 2.5 with walls of many reflectances, a ceiling that shines and a box that floats in it;
/// the last wall is a window, if that is wanted.
inline Room furnished_room(bool window = false) {
  Room room;
  const std::optional<Finish> last = window ? std::nullopt : std::optional(finish(0.2));
  room.box({0, 0, 0}, {4, 3, 2.5}, true,
           {finish(0.3), finish(0.1, 10), finish(0.5), finish(0.7), finish(0.8), last});
  room.box({1, 1, 0.5}, {2, 2.2, 1.7}, false, finish(0.6));
  return room;
}

/// The automatic method, down to this relative residual.
inline SolveOptions to_residual(double tolerance) {
  SolveOptions options;
  options.tolerance = tolerance;
  return options;
}

/// What stands at the end of the road, with what the laws need from its middle.
struct Lit {
  PatchMesh mesh;
  Enclosures enclosures;
  std::unique_ptr<DenseOperator> transport;
  PatchField reflectance, emission;
  RadiositySolution light;
  Energy energy;
};

struct RoadOptions {
  MeshingOptions meshing{.patches = 300};
  double accuracy = 1e-4;
  SolveOptions solve = to_residual(1e-12);
};

inline Lit lit(const Scene& scene, const RoadOptions& options = {}) {
  Lit lit;
  lit.mesh = mesh_scene(scene, options.meshing);
  lit.enclosures = find_enclosures(lit.mesh, RayScene(lit.mesh.occluders));
  FormFactors factors =
      form_factors(lit.mesh, {.accuracy = options.accuracy, .precision = Precision::float64});
  lit.transport = close_rows(std::move(factors.exchange_areas), lit.mesh.areas, lit.enclosures).transport;
  lit.reflectance = reflectance(lit.mesh);
  lit.emission = emission(lit.mesh);
  lit.light = solve(*lit.transport, lit.reflectance, lit.emission, options.solve);
  lit.energy = energy(*lit.transport, lit.reflectance, lit.emission, lit.light);
  return lit;
}

/// Area-weighted mean of a field over each group, first channel.
inline std::vector<double> group_means(const PatchMesh& mesh, const PatchField& field) {
  std::vector<double> sums(mesh.group_names.size()), areas(mesh.group_names.size());
  for (int i = 0; i < mesh.size(); ++i) {
    sums[mesh.groups[i]] += mesh.areas[i] * field(i, 0);
    areas[mesh.groups[i]] += mesh.areas[i];
  }
  for (std::size_t g = 0; g < sums.size(); ++g) sums[g] /= areas[g];
  return sums;
}

}  // namespace luxel::testing
