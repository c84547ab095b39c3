#pragma once

#include <cstdint>
#include <vector>

#include "luxel/patch_mesh.h"
#include "luxel/ray_scene.h"
#include "operator_error/lamp_points.h"
#include "patch_locator.h"

namespace luxel {

/// Irradiance of single patches by many rays of their own, from radiosities that are given: rays over the
/// hemisphere, which bring what they meet, and rays to points of the lamps, both weighted by what either
/// would have found (balance heuristic). In double precision, and with nothing of what the operators are
/// made of.
/// Source: Veach and Guibas 1995, Optimally combining sampling techniques for Monte Carlo rendering.
class Probe {
 public:
  /// @param order  the patches, neighbours together
  /// @param part   N: of each patch, 0 .. parts - 1
  Probe(const PatchMesh& mesh, const RayScene& occluders, const PatchField& emission,
        const PatchField& radiosity, std::span<const int> order, std::span<const std::int32_t> part,
        int parts);

  struct Look {
    Eigen::RowVectorXd irradiance;  ///< m [W/m2]
    std::vector<int> met;           ///< rays that met each part
    double row_sum = 0;             ///< share of rays that met a patch
    std::int64_t rays = 0;          ///< cast
  };

  /// Looks of different seeds are independent.
  /// @param rays  over the hemisphere; to lamps as many, where lamps are small
  Look look(int patch, int rays, std::uint64_t seed) const;

 private:
  void add_lamps(int patch, const LampPoints::View& lamps, int rays, std::uint64_t seed, Look& look) const;

  const PatchMesh& mesh_;
  const RayScene& occluders_;
  const PatchField& emission_;
  const PatchField& radiosity_;
  std::span<const std::int32_t> part_;
  int parts_;
  LampPoints lamps_;
  PatchLocator locator_;
};

}  // namespace luxel
