#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "luxel/patch_mesh.h"
#include "luxel/transport_operator.h"
#include "luxel/vector.h"

namespace luxel {

/// Form factors between groups of patches.
struct GroupFactors {
  std::vector<double> areas;  ///< A_I of each group [m2]
  Eigen::MatrixXd
      form_factors;  ///< F_IJ = sum over i in I, j in J of A_i F_ij / A_I; rows of 0 for groups of no patch
};

/// @param groups  N: the group of each patch, in [0, count)
/// Cost: one application of the operator for every three groups.
/// @throws std::invalid_argument for shapes or a group out of range
GroupFactors group_form_factors(const TransportOperator& transport, std::span<const int> groups, int count);

/// Form factors from an infinitesimal patch at a point to groups of patches.
struct PointFactors {
  std::vector<double> form_factors;  ///< one for each of mesh.group_names: fronts seen from the point
  double open = 0;                   ///< share of its directions that escape or meet a back
  double error = 0;       ///< standard error of the largest of these figures; 0 where they are exact
  std::int64_t rays = 0;  ///< 0 where they are exact
};

/// Shares of what a point sends, or receives, by a front with unit `normal`, to the groups of the mesh, with
/// visibility: what patches hide is cut away polygon by polygon, exactly, where patches times occluders are
/// below 10^8; by 262 144 quasi-random rays elsewhere.
/// @throws std::invalid_argument if the normal is not of length 1 (within 1e-6) or the point is not finite
PointFactors point_to_groups(const PatchMesh& mesh, const Vec3& point, const Vec3& normal);

}  // namespace luxel
