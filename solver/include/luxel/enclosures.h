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
  /// N: standard error of open_share + back_share; 1 / rays where all rays agree though the enclosure is
  /// open; 0 in closed enclosures
  std::vector<double> share_error;
  /// N: rays that measured the shares; 0 where no ray did; empty where that is not known
  std::vector<int> share_rays;
  std::int64_t rays = 0;  ///< cast from patches; 0 where the surfaces alone prove every enclosure closed
};

/// Space is cut into cells by the occluders, whose sides are joined around their edges. Where those match,
/// and nothing touches or crosses, the answer is proven and needs no ray: a cell is closed when it is bounded
/// and patches cover all of it. Elsewhere (edges that only one triangle has, T-vertices, bodies that stand on
/// an uncut floor, surfaces that run through each other, more than 30 000 occluder triangles) rays decide,
/// and lines close to each free edge look through holes that rays would miss, down to 1e-6 of the diagonal.
/// What may then be missed is an opening without free edges that fewer than about one ray in rays_per_patch
/// times the patches finds: it counts as closed. Cracks below 4e-7 of the diagonal are closed.
///
/// @param rays_per_patch  cosine-distributed quasi-random directions from quasi-random points of each patch,
/// >= 16
/// @param share_accuracy  where the standard error of a patch's shares exceeds this, up to 64 times the rays
/// are cast for it; 0: never
Enclosures find_enclosures(const PatchMesh& mesh, const RayScene& occluders, int rays_per_patch = 256,
                           const Progress& progress = {}, double share_accuracy = 0);

/// Takes the shares of sky from form factors of this accuracy, for patches of open enclosures in which no ray
/// met a back, but where a share is not a number: the error of a share of sky is then at most 0.7 accuracy
/// sqrt(share), as of every sum of form factors. Where one patch sees a back, another may see one of which no
/// ray of its own told.
void take_sky_shares(Enclosures& enclosures, const std::vector<double>& sky_shares, double accuracy);

/// What patch i's row sum may differ from 1 - open_share - back_share by and be right, at a chance of 1e-2
/// for any of all N patches to exceed it (Bonferroni): standard errors times sqrt(2 ln(N / 1e-2)), which
/// holds for everything that is no more spread out than a normal distribution. The standard error of rays is
/// taken to be that of independent ones: a scrambled net gains on that, on some patches nothing (Owen 1997,
/// Ann. Statist. 25: at most e times the variance of independent points).
double largest_by_chance(const Enclosures& enclosures, int patch);

/// Measures the shares of the patches of open enclosures anew, with as many rays as bring their standard
/// errors down to the accuracy, but at most 64 times as many as before and `most_rays` in all: what the row
/// sums of an open scene are compared with. Cost: about 0.3 us a ray.
/// @param enclosures      as find_enclosures gave them, with rays_per_patch
/// @param accuracy        standard error of a share, > 0
void measure_shares(Enclosures& enclosures, const PatchMesh& mesh, const RayScene& occluders, double accuracy,
                    std::int64_t most_rays, int rays_per_patch = 256, const Progress& progress = {});

}  // namespace luxel
