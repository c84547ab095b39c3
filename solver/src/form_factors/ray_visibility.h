#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "form_factors/cluster_tree.h"
#include "form_factors/occluder_scene.h"

namespace luxel {

/// A pair whose visibility is to be sampled; working units, patches in tree order.
struct RayPair {
  int s = 0, t = 0;
  double unhidden = 0;   ///< exchange area with nothing between
  double tolerance = 0;  ///< of the exchange area that is left
};

/// What rays found of a pair.
struct RayShare {
  double visible = 0;  ///< share of the exchange area that is left
  double error = 0;    ///< estimated standard error of that share
  std::int64_t rays = 0;
};

// Quasi-random lines leave an error of share_error_constant sqrt(p (1 - p)) N^-share_error_order in a share
// p: measured on partly hidden pairs of rotated boxes against clipping.
constexpr double share_error_constant = 1.25;
constexpr double share_error_order = 0.7;

// Many pairs that come to rays are wholly visible or wholly hidden after all: the share of a pair has the
// distribution Beta(prior, prior) before any ray is cast. Smaller shadows than 1 / 16 were missed with 0.15.
constexpr double share_prior = 0.5;

/// Standard error of a share that so many rays found. Never 0: rays that agree may all have missed a small
/// part.
double share_error(double share, double rays);

/// Rays that a pair gets before any has been looked at: a power of two, as many as reach the tolerance,
/// relative to the pair, whatever share of it is in sight, or most_first_rays. Where fewer suffice, their
/// number does not depend on what they find: shares are unbiased, and errors of pairs have either sign.
int first_rays(double relative_tolerance);
constexpr int most_first_rays = 16;

/// Standard error of so many rays where half of a pair is in sight, the largest there is.
double worst_share_error(int rays);

/// Visibility of pairs by rays between quasi-random points of both patches, weighted by the kernel of the
/// exchange area. Rays go in packets of sixteen, pair after pair; pairs whose error is above their tolerance
/// after their first rays get twice as many, up to a limit. Every pair has a point set of its own, from the
/// seed and its two patches, so that the result does not depend on how pairs are grouped. Safe from many
/// threads.
class RayVisibility {
 public:
  RayVisibility(const ClusterTree& tree, const OccluderScene& scene, std::uint64_t seed);

  std::vector<RayShare> visible(std::span<const RayPair> pairs) const;

 private:
  const ClusterTree& tree_;
  const OccluderScene& scene_;
  std::uint64_t seed_;
};

}  // namespace luxel
