#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "form_factors/cluster_tree.h"
#include "form_factors/occluder_set.h"

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

/// Visibility of pairs by rays between quasi-random points of both patches, weighted by the kernel of the
/// exchange area. Rays go in packets of sixteen, pair after pair; pairs whose error is above their tolerance
/// get twice as many rays, up to a limit. Every pair has a point set of its own, from the seed and its two
/// patches, so that the result does not depend on how pairs are grouped. Safe from many threads.
class RayVisibility {
 public:
  RayVisibility(const ClusterTree& tree, const OccluderSet& set, std::uint64_t seed);
  ~RayVisibility();
  RayVisibility(RayVisibility&&) noexcept;

  std::vector<RayShare> visible(std::span<const RayPair> pairs) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace luxel
