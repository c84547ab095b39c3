#pragma once

#include <cstdint>
#include <vector>

#include "luxel/patch_mesh.h"
#include "luxel/progress.h"
#include "luxel/ray_scene.h"

namespace luxel {

/// What the directions from each patch's front meet, measured by rays: fronts, backs or nothing.
struct Enclosures {
  bool closed = false;         ///< no direction from the front of any patch escapes or meets a back
  int count = 0;               ///< connected components of "sees"
  std::vector<int> enclosure;  ///< N: the component of each patch, from 0, numbered by their first patch
  std::vector<char> enclosure_closed;  ///< `count` flags
  std::vector<double> open_share;      ///< N: cosine-weighted share of directions that escape, in [0, 1]
  std::vector<double> back_share;      ///< N: share that meets a back
  std::vector<double>
      share_error;  ///< N: standard error of open_share + back_share; 0 where no ray did either
  std::int64_t rays = 0;
};

/// @param rays_per_patch  cosine-distributed quasi-random directions from quasi-random points of each patch,
/// >= 16
Enclosures find_enclosures(const PatchMesh& mesh, const RayScene& occluders, int rays_per_patch = 256,
                           const Progress& progress = {});

}  // namespace luxel
