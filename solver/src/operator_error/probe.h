#pragma once

#include <cstdint>
#include <vector>

#include "luxel/patch_mesh.h"
#include "luxel/ray_scene.h"
#include "transport/gather/gather_rays.h"
#include "transport/gather/lamps.h"
#include "transport/gather/shadow_rays.h"

namespace luxel {

/// Irradiance of single patches by many rays of their own, from radiosities that are given.
class Probe {
 public:
  /// Lamps are sampled apart where the gather does so.
  /// @param rays_a_look  of each look at a patch; of each lamp about as many
  Probe(const PatchMesh& mesh, const RayScene& occluders, const GatherRays& rays, const PatchField& emission,
        const PatchField& radiosity, int rays_a_look);

  struct Look {
    Eigen::RowVectorXd irradiance;  ///< m [W/m2]
    double row_sum = 0;             ///< share of rays that met a patch
    std::int64_t rays = 0;          ///< cast
  };

  /// Looks of different seeds are independent.
  Look look(int patch, std::uint64_t seed) const;

 private:
  const PatchMesh& mesh_;
  const RayScene& occluders_;
  const GatherRays& rays_;
  std::vector<Lamp> lamps_;
  PatchField field_;  // what the rays bring: U = B - E, or B
  PatchNet net_;
  int rays_a_lamp_;
  ShadowRays shadow_rays_;
};

}  // namespace luxel
