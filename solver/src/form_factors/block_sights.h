#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "form_factors/cluster_tree.h"
#include "form_factors/occluder_scene.h"

namespace luxel {

/// How two patches see each other, as far as rays tell.
enum class Sight : char {
  unknown,  ///< not asked for
  whole,    ///< all rays arrive
  none,     ///< no ray arrives
  part      ///< some do: to be looked at more closely
};

/// A corner of a patch in tree order.
struct PatchCorner {
  int patch = 0, corner = 0;
  bool operator==(const PatchCorner&) const = default;
};

struct BlockSights {
  std::vector<Sight> sights;  ///< size(a) x size(b), row by row
  std::int64_t rays = 0;
};

/// Sorts the pairs of blocks into those that see each other, those that do not, and those that do in part.
/// Rays are shared between neighbours: as long as all rays of a pair of clusters agree they speak for all its
/// pairs; where they do not agree, each half is asked by itself. A pair may then be held for whole or hidden
/// wrongly, with either sign, and hardly by more than a part of itself: what borders on a boundary of the
/// hidden region wrongly on the one side does so as often on the other. Safe from many threads.
class SightSorter {
 public:
  static constexpr int largest_side = 32;  ///< patches of the clusters that sort() takes

  SightSorter(const ClusterTree& tree, const OccluderScene& scene, std::uint64_t seed);

  /// @param a, b      clusters of at most largest_side patches
  /// @param unhidden  size(a) x size(b) exchange areas with nothing between, working units; 0: do not ask
  /// @param factor    rays that agree are as many as make the error of rows below `factor` sqrt(G A), G what
  /// the row exchanges with the other cluster and A the area of its patch
  BlockSights sort(int a, int b, std::span<const double> unhidden, double factor) const;

  double area(int cluster) const { return areas_[static_cast<std::size_t>(cluster)]; }
  /// The corners that reach furthest in eight directions along the cluster.
  std::span<const PatchCorner> outermost(int cluster) const {
    return outermost_[static_cast<std::size_t>(cluster)];
  }

 private:
  const ClusterTree& tree_;
  const OccluderScene& scene_;
  std::uint64_t seed_;
  std::vector<double> areas_;
  std::vector<std::vector<PatchCorner>> outermost_;
};

}  // namespace luxel
