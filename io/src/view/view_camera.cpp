#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "luxel/view.h"

namespace luxel {

namespace {

// Share of the total area by which fronts must look to one side for it to be the open one: above what
// rounding and windows give, below a box that lacks one of its six sides (1/5)
constexpr double open_side = 0.05;

// Closer to an axis than this [cosine, 37 degrees], the open side is taken to be that axis: upright walls
// stay upright in the picture
constexpr double near_axis = 0.8;

// Room left around the scene in the picture
constexpr double margin = 1.05;

struct Box {
  Vec3 low, high;
  Vec3 centre() const { return (low + high) / 2; }
  Vec3 half() const { return (high - low) / 2; }
};

Box bounding_box(const std::vector<Vec3>& points) {
  Box box{points.front(), points.front()};
  for (const Vec3& x : points) {
    box.low = box.low.cwiseMin(x);
    box.high = box.high.cwiseMax(x);
  }
  return box;
}

Vec3 mean_normal(const PatchMesh& mesh) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < mesh.size(); ++i) sum += mesh.areas[i] * mesh.normals[i];
  return sum / total_area(mesh);
}

Vec3 snapped(const Vec3& direction) {
  int axis = 0;
  const double largest = direction.cwiseAbs().maxCoeff(&axis);
  return largest < near_axis ? direction : Vec3(std::copysign(1.0, direction[axis]) * Vec3::Unit(axis));
}

// Distance from the centre along `towards` at which every corner of the box is in the picture
double fitting_distance(const Box& box, const Vec3& towards, const Camera& camera) {
  const double tangent = std::tan(camera.fov * std::numbers::pi / 360) / margin;
  const double wide_tangent = tangent * camera.width / camera.height;
  const Vec3 right = camera.up.cross(towards).normalized();
  const Vec3 up = towards.cross(right);
  double distance = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 x =
        box.half().cwiseProduct(Vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1));
    distance = std::max({distance, x.dot(towards) + std::abs(x.dot(right)) / wide_tangent,
                         x.dot(towards) + std::abs(x.dot(up)) / tangent});
  }
  return distance;
}

// The horizontal axis along which the near face of the box has the shape of the picture most nearly
Vec3 best_wall(const Box& box, const Camera& camera) {
  const Vec3 size = box.half();
  const double picture = static_cast<double>(camera.width) / camera.height;
  const auto mismatch = [&](double width) { return std::abs(std::log(width / (size[1] * picture))); };
  return mismatch(size[0]) <= mismatch(size[2]) ? Vec3::UnitZ() : Vec3::UnitX();
}

}  // namespace

Camera view_camera(const PatchMesh& mesh, int width, int height) {
  if (mesh.camera) return *mesh.camera;
  Camera camera;
  camera.width = width;
  camera.height = height;
  if (mesh.vertices.empty()) return camera;
  const Box box = bounding_box(mesh.vertices);
  const Vec3 open = mean_normal(mesh);
  const Vec3 towards = open.norm() > open_side ? snapped(open.normalized()) : best_wall(box, camera);
  // seen straight from above or below, north is up
  if (std::abs(towards[1]) > 0.99) camera.up = Vec3(0, 0, -1);
  camera.target = box.centre();
  camera.eye = box.centre() + std::max(fitting_distance(box, towards, camera), 1e-6) * towards;
  return camera;
}

}  // namespace luxel
