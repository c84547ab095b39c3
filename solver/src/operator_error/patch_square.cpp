#include "operator_error/patch_square.h"

#include <Eigen/Geometry>
#include <cmath>

namespace luxel {

PatchSquare::PatchSquare(const PatchMesh& mesh, int patch) {
  const auto& corners = mesh.corners[patch];
  corner_ = mesh.vertices[corners[0]];
  first_ = mesh.vertices[corners[1]] - corner_;
  second_ = mesh.vertices[corners[2]] - corner_;
  third_ = mesh.vertices[corners[corners[3] < 0 ? 2 : 3]] - corner_;
  const double in_first = first_.cross(second_).norm(), in_other = second_.cross(third_).norm();
  share_ = in_first / (in_first + in_other);
}

// A triangle by the square root (Turk 1990): s leads away from the corner, t across.
Vec3 PatchSquare::operator()(double s, double t) const {
  const bool in_first = s < share_;
  const double root = std::sqrt(in_first ? s / share_ : (s - share_) / (1 - share_));
  const Vec3& from = in_first ? first_ : second_;
  const Vec3& to = in_first ? second_ : third_;
  return corner_ + root * ((1 - t) * from + t * to);
}

}  // namespace luxel
