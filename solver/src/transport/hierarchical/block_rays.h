#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "transport/hierarchical/block_end.h"

struct RTCSceneTy;

namespace luxel {

/// Rays between two ends and how many of them arrived, by the nodes in whose parts of the ends they begin and
/// end: [4 a + b]. Rays that run behind either end's surface carry no light and do not count.
struct RayCount {
  std::array<int, 16> cast{}, arrived{};
  int drawn = 0;                         ///< pairs of points
  int all = 0, visible = 0;              ///< rays that count, and those that arrived
  int corners = 0, corners_visible = 0;  ///< of those between outermost points, which count nowhere else

  bool unanimous() const { return visible == 0 || visible == all; }
  /// Whether rays between outermost points bear out those that agree.
  bool borne_out() const { return all == 0 || corners_visible == (visible > 0 ? corners : 0); }
  double share() const { return all > 0 ? static_cast<double>(visible) / all : 1; }
  /// Standard error of share(); never 0, since rays that agree may all have missed a small part.
  double error() const;
  /// The share at one pair of nodes; that of all where it has no rays of its own.
  double share(int pair) const { return cast[pair] > 0 ? double(arrived[pair]) / cast[pair] : share(); }
};

/// Casts rays between ends of blocks against the occluders, sixteen at a time: one for each pair of nodes,
/// between quasi-random points of their parts of the ends. Points depend on the seed and the two ends alone.
class BlockRays {
 public:
  BlockRays(const PatchHierarchy& hierarchy, RTCSceneTy* scene, std::uint64_t seed);

  /// Draws rays up to `wanted` in all, a multiple of 16.
  void cast(const BlockEnd& r, const BlockEnd& s, int wanted, RayCount& count) const;
  /// The share of what two single patches exchange that nothing hides, by rays that weigh what they carry:
  /// doubled until the share's standard error is `allowed`, 4096 pairs of points at most.
  double visible_share(const BlockEnd& r, const BlockEnd& s, double allowed, int& rays) const;
  /// Sixteen rays between the outermost points of both ends, where a shadow shows first.
  void cast_between_corners(const BlockEnd& r, const BlockEnd& s, RayCount& count) const;

 private:
  struct Point {
    Vec3 at, normal;
    int node;
  };
  Point point(const BlockEnd& end, int node, double u, double v) const;
  Point corner(const BlockEnd& end, int node) const;
  Point point_of_patch(const BlockEnd& end, int patch, double u, double v) const;

  const PatchHierarchy& hierarchy_;
  std::vector<double> areas_;  // of the patches before each position of the order, and of all [m2]
  RTCSceneTy* scene_;
  std::uint64_t seed_;
  std::vector<std::uint32_t> words_;  // of the points of visible_share()
};

}  // namespace luxel
