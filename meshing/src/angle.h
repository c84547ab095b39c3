#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "luxel/vector.h"

namespace luxel {

constexpr double degrees_per_radian = 180 / std::numbers::pi;

/// The angle between two directions of any length, in [0, pi]; right for nearly parallel ones too.
inline double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace luxel
