#pragma once

#include <Eigen/Core>

namespace luxel {

/// A point or direction in space [m].
using Vec3 = Eigen::Vector3d;

/// One value for each of the three channels: red, green, blue (linear, Rec. 709 primaries).
using Rgb = Eigen::Array3d;

/// One row per patch, one column per channel or right-hand side; row-major, so that a patch's channels lie
/// together.
using PatchField = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace luxel
