#pragma once

#include <vector>

#include "form_factors/polygon.h"
#include "luxel/patch_mesh.h"

namespace luxel {

/// A node of the cluster tree: patches order[begin .. end), what bounds them and how they face.
struct Cluster {
  int begin = 0, end = 0;
  int left = -1, right = -1;  ///< children; -1 for a single patch
  Polygon hull;        ///< planar: convex polygon around the patches in their plane; else: box corners (8)
  bool planar = true;  ///< all patches lie in one plane, up to rounding
  Plane plane;         ///< of a planar cluster; else mean normal through the centre
  double cone = 0;     ///< largest angle between the mean normal and a patch's normal [rad]; 0 if planar
  Vec3 centre;         ///< of the bounding sphere
  double radius = 0;   ///< of the bounding sphere
  double edge = 0;     ///< longest edge of a patch inside
};

/// Patches in working coordinates, permuted so that each cluster is one contiguous range, under a binary
/// tree: coplanar groups first (by tolerance, never by rounding to bins), split in their plane; groups, and
/// patches of curved meshes, gathered by position and normal above. Children's sizes are multiples of 8 where
/// possible, for the kernels.
struct ClusterTree {
  std::vector<WorkPatch> patches;  ///< in tree order
  std::vector<Cluster> clusters;   ///< parents before children
  int root = 0;
  Vec3 centre;  ///< working = (x - centre) * scale
  double scale = 1;
};

ClusterTree cluster_tree(const PatchMesh& mesh);

/// Whether some point of a's patches lies in front of some patch of b and the other way round; false proves
/// that no light goes between them.
bool may_face(const Cluster& a, const Cluster& b);

}  // namespace luxel
