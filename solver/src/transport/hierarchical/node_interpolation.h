#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "luxel/vector.h"
#include "transport/hierarchical/active_tree.h"
#include "transport/hierarchical/patch_hierarchy.h"

namespace luxel {

/// Between the patches and the unknowns of an active tree. The unknowns' areas are such that means around the
/// nodes and interpolation from them are adjoint, and both leave constants alone.
class NodeInterpolation {
 public:
  NodeInterpolation(const PatchHierarchy& hierarchy, const ActiveTree& tree);

  int patches() const { return static_cast<int>(areas_.size()); }
  int unknowns() const { return static_cast<int>(node_areas_.size()); }
  const std::vector<double>& areas() const { return areas_; }            ///< of patches [m2]
  const std::vector<double>& node_areas() const { return node_areas_; }  ///< of unknowns [m2]
  /// A patch of each unknown's cluster.
  std::vector<int> patch_of_unknowns() const;

  /// Area-weighted means around the nodes. x: patches x columns, y: unknowns x columns, row-major.
  void to_nodes(const double* x, double* y, int columns) const;
  /// Values on patches, interpolated at their centroids.
  void to_patches(const double* x, double* y, int columns) const;
  std::size_t bytes() const;

 private:
  struct End {
    int begin, end;  // positions in order_
    int unknown;
    bool single;
  };
  std::array<double, 4> functions(int position) const;

  std::vector<End> ends_;
  std::vector<int> order_;                         // patches
  std::vector<std::array<float, 2>> coordinates_;  // by position: in spreads, from the cluster's middle
  std::vector<double> areas_, node_areas_;
};

}  // namespace luxel
