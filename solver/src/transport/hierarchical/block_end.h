#pragma once

#include <array>
#include <cstdint>

#include "form_factors/cluster_tree.h"
#include "form_factors/shaft.h"
#include "transport/hierarchical/patch_hierarchy.h"

namespace luxel {

/// One end of a block: a cluster or a single patch with all that the kernel, the facing test and the shaft
/// need, in working units.
struct BlockEnd {
  int cluster = 0;
  bool single = false;
  bool usable = false;     ///< may be an end of a block that is not divided
  bool rectangle = false;  ///< of patches that fill the rectangle along its axes
  double area = 0;
  double roughness = 0;                                   ///< of a curved cluster; 0 where flat
  alignas(32) std::array<double, 4> x, y, z, nx, ny, nz;  ///< nodes and their normals
  std::array<double, 4> weights;                          ///< of the nodes: shares of the area
  Cluster bounds;                                         ///< hull, plane or cone, sphere; no patches
  ClusterAxes axes;                                       ///< of a flat cluster
  ShaftEnd shaft;                                         ///< the hull again
};

/// @param with_shaft  there are occluders: `shaft` is filled
BlockEnd block_end(const PatchHierarchy& hierarchy, int cluster, bool with_shaft);

/// Of all that lies in one plane with the end and sends as it does; of a curved end its own. Working units.
double plane_area(const PatchHierarchy& hierarchy, const BlockEnd& end);

/// Kernel cos cos / (pi d^2) between all nodes of two ends, [4 a + b]; 0 where either looks away.
struct BlockKernel {
  alignas(32) std::array<double, 16> values;
  double largest = 0;
  double mean = 0;    ///< weighted by both ends' nodes
  double middle = 0;  ///< between the two middles: what interpolation from the nodes takes for the mean

  /// The values as [4 b + a].
  std::array<double, 16> from_other_end() const;
};
BlockKernel block_kernel(const BlockEnd& r, const BlockEnd& s);

}  // namespace luxel
