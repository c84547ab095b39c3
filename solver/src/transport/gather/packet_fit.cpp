#include "transport/gather/packet_fit.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace luxel {

namespace {

// Three numbers are fitted: with fewer patches the scatter about them says little.
constexpr std::size_t least_patches = 8;

// Below this the scatter is hardly noise: the field is not linear here, and the fit would do harm.
constexpr double least_share = 0.25;

// Patches in one plane [sine, and share of the packet's extent]: above the rounding of coordinates.
constexpr double flat = 1e-6;

}  // namespace

double fit_packet(const PatchMesh& mesh, std::span<const int> patches, const PacketField& first_half,
                  PacketField& values) {
  const std::size_t count = patches.size();
  if (count < least_patches) return 0;
  const Vec3& normal = mesh.normals[patches[0]];
  const Vec3 x = normal.unitOrthogonal(), y = normal.cross(x);
  std::array<Eigen::Array2d, GatherOperator::lanes> at;
  Eigen::Array2d middle(0, 0);
  for (std::size_t k = 0; k < count; ++k) {
    if (mesh.polygons[patches[k]] != mesh.polygons[patches[0]] ||
        mesh.normals[patches[k]].dot(normal) < 1 - flat) {
      return 0;
    }
    const Vec3 from = mesh.centroids[patches[k]] - mesh.centroids[patches[0]];
    at[k] = {from.dot(x), from.dot(y)};
    middle += at[k] / static_cast<double>(count);
  }
  Eigen::Array4d mean = Eigen::Array4d::Zero(), along_x = mean, along_y = mean;
  double xx = 0, xy = 0, yy = 0, noise = 0;
  for (std::size_t k = 0; k < count; ++k) {
    at[k] -= middle;
    xx += at[k][0] * at[k][0];
    xy += at[k][0] * at[k][1];
    yy += at[k][1] * at[k][1];
    mean += values[k] / static_cast<double>(count);
    along_x += at[k][0] * values[k];
    along_y += at[k][1] * values[k];
    noise += (values[k] - first_half[k]).square().sum();
  }
  const double determinant = xx * yy - xy * xy;
  if (!(determinant > flat * xx * yy)) return 0;
  const Eigen::Array4d slope_x = (along_x * yy - along_y * xy) / determinant;
  const Eigen::Array4d slope_y = (along_y * xx - along_x * xy) / determinant;
  const auto fitted = [&](std::size_t k) -> Eigen::Array4d {
    return mean + at[k][0] * slope_x + at[k][1] * slope_y;
  };
  double scatter = 0;
  for (std::size_t k = 0; k < count; ++k) scatter += (values[k] - fitted(k)).square().sum();
  if (!(scatter > 0)) return 0;
  noise /= static_cast<double>(count);
  scatter /= static_cast<double>(count - 3);
  const double share = std::min(1.0, noise / scatter);
  if (share < least_share) return 0;
  for (std::size_t k = 0; k < count; ++k) values[k] += share * (fitted(k) - values[k]);
  return share;
}

}  // namespace luxel
