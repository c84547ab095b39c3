#include "view_rays.h"

#include <Eigen/Geometry>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>

namespace luxel {

namespace {

// More pixels than any screen or print has; image arrays stay below 4 GB
constexpr std::int64_t most_pixels = std::int64_t(1) << 28;

// Below this sine of the angle between `up` and the viewing direction the picture's upright is rounding
constexpr double least_sine = 1e-9;

double radical_inverse(std::uint32_t i) {
  double result = 0;
  for (double digit = 0.5; i > 0; i >>= 1, digit /= 2) result += (i & 1) * digit;
  return result;
}

// From a uniform number in (0, 1) to one in (-1, 1) with density 1 - |x|
double tent(double uniform) {
  const double u = 2 * uniform - 1;
  return std::copysign(1 - std::sqrt(1 - std::abs(u)), u);
}

}  // namespace

ViewRays::ViewRays(const Camera& camera) {
  const Vec3 view = camera.target - camera.eye;
  if (!view.allFinite() || !(view.norm() > 0)) throw std::invalid_argument("camera: eye and target coincide");
  forward_ = view.stableNormalized();
  const Vec3 side = forward_.cross(camera.up.stableNormalized());
  if (!side.allFinite() || !(side.norm() > least_sine)) {
    throw std::invalid_argument("camera: up is parallel to the viewing direction");
  }
  if (!(camera.fov > 0 && camera.fov < 180)) throw std::invalid_argument("camera: fov is not in (0, 180)");
  if (camera.width < 1 || camera.height < 1 ||
      static_cast<std::int64_t>(camera.width) * camera.height > most_pixels) {
    throw std::invalid_argument("camera: not between 1 and 2^28 pixels");
  }
  const double pixel = 2 * std::tan(camera.fov * std::numbers::pi / 360) / camera.height;
  right_ = pixel * side.normalized();
  down_ = pixel * forward_.cross(side.normalized());
  top_left_ = forward_ - camera.width / 2.0 * right_ - camera.height / 2.0 * down_;
}

Vec3 ViewRays::direction(double x, double y) const {
  return (top_left_ + x * right_ + y * down_).normalized();
}

std::vector<Eigen::Vector2d> tent_samples(int count) {
  std::vector<Eigen::Vector2d> samples(count);
  for (int i = 0; i < count; ++i) {
    samples[i] = {tent((i + 0.5) / count), tent(radical_inverse(i) + 0.5 / count)};
  }
  return samples;
}

}  // namespace luxel
