#pragma once

#include <array>
#include <span>
#include <vector>

#include "form_factors/polygon.h"
#include "form_factors/working_frame.h"
#include "luxel/enclosures.h"
#include "luxel/patch_mesh.h"

namespace luxel {

/// Where a cluster is bilinear: coordinates (s, t) along two unit vectors in working units, nodes at
/// (+-spread_s, +-spread_t) from the middle. Middle and spreads are mean and standard deviations of the
/// patches' area, so that the four nodes with their weights integrate every quadratic over the cluster,
/// whatever its shape; on rectangles they are the Gauss points.
struct ClusterAxes {
  Vec3 middle, u, v;
  double spread_s = 0, spread_t = 0;

  /// Values of the four bilinear functions that are 1 at one node and 0 at the others; their sum is 1.
  std::array<double, 4> functions(const Vec3& x) const;
};

/// Patches [begin, end) of PatchHierarchy::order, more than one.
struct PatchCluster {
  int begin = 0, end = 0;
  int parent = -1;
  std::array<int, 4> children{-1, -1, -1, -1};  ///< ends with -1; see PatchHierarchy
  int child_count = 0;
  int flat_group = -1;  ///< all patches lie in one plane, face one side, and have one finish; -1: they do not
  double area = 0;      ///< working units
  ClusterAxes axes;
  std::array<double, 4> weights;  ///< of the nodes: shares of the area; sum 1
  bool usable = false;            ///< the nodes' weights are all well above 0: the cluster may be an
                        ///< end of a block; what is curved and usable has no curved parts that are not
  Vec3 centre;  ///< of a sphere around the patches
  double radius = 0;
  std::array<double, 4>
      box{};        ///< flat: least and most s, least and most t of the patches' corners, from the middle
  int curved = -1;  ///< not flat: index into PatchHierarchy::curved
};

/// What a cluster needs in addition where its patches do not lie in one plane.
struct CurvedCluster {
  std::array<Vec3, 4> nodes,
      normals;     ///< means around each node; normals are shorter than 1 where patches differ
  Vec3 low, high;  ///< box around the corners
  Vec3 normal;     ///< of the cone of all patches' normals
  double cone_cosine = 1, cone_sine = 0;
  Span setback;  ///< how far the patches' planes lie behind the centre, least and most
  double roughness =
      0;  ///< RMS difference of a patch's normal and position (in radii) from the interpolated one
};

/// A plane's side with one finish, of one enclosure.
struct FlatGroup {
  Vec3 u, v, normal;
  double offset = 0;
  double area = 0;  ///< working units
  Vec3 low, high;   ///< box around the corners
  int finish = 0;
  int enclosure = 0;
  bool closed = false;  ///< its enclosure is
};

/// Clusters of patches for the hierarchical operator. Patches of one polygon, side, finish and enclosure are
/// gathered first and split along their plane's axes; groups (facets, on curved meshes) are gathered by
/// position and normal above that. Single patches are clusters too, without a PatchCluster: number
/// cluster_count() + k for patch order[k].
struct PatchHierarchy {
  const PatchMesh* mesh = nullptr;
  WorkingFrame frame;
  std::vector<int> order;  ///< patches
  std::vector<int> group;  ///< of order[k]: its FlatGroup
  std::vector<FlatGroup> groups;
  std::vector<PatchCluster> clusters;  ///< parents before children
  std::vector<CurvedCluster> curved;
  int root = 0;  ///< a cluster, or the only patch

  int cluster_count() const { return static_cast<int>(clusters.size()); }
  bool single(int cluster) const { return cluster >= cluster_count(); }
  int patch(int single_cluster) const { return order[single_cluster - cluster_count()]; }
};

/// Cost: O(N log N); about 0.5 us a patch.
PatchHierarchy patch_hierarchy(const PatchMesh& mesh, const Enclosures& enclosures);

}  // namespace luxel
