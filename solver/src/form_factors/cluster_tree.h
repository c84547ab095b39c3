#pragma once

#include <vector>

#include "form_factors/polygon.h"
#include "luxel/patch_mesh.h"

namespace luxel {

/// A node of the cluster tree: patches [begin, end) of ClusterTree::patches, what bounds them and how they
/// face.
struct Cluster {
  int begin = 0, end = 0;
  int left = -1, right = -1;  ///< children; -1 for a single patch
  Polygon hull;        ///< planar: convex polygon around the patches in their plane; else: box corners (8)
  bool planar = true;  ///< all patches lie in one plane, up to `thickness`, and share it bit for bit
  Plane plane;         ///< of a planar cluster; else mean normal through the centre
  double cone = 0;     ///< largest angle between the mean normal and a patch's normal [rad]; 0 if planar
  double cone_cosine = 1, cone_sine = 0;  ///< of `cone`
  Span setback;  ///< how far the patches' planes lie behind the centre, least and most; 0 if planar
  double thickness =
      0;              ///< largest distance of a corner from the plane of a planar cluster: rounding; else 0
  Vec3 centre;        ///< of the bounding sphere
  double radius = 0;  ///< of the bounding sphere
  double edge = 0;    ///< longest edge of a patch inside

  int size() const { return end - begin; }
  bool leaf() const { return left < 0; }
};

/// Patches in working coordinates, permuted so that each cluster is one contiguous range, under a binary
/// tree: coplanar groups first (by tolerance, never by rounding to bins), split in their plane; groups, and
/// patches of curved meshes, gathered by position and normal above. Children's sizes are multiples of 8 where
/// possible, for the kernels.
struct ClusterTree {
  std::vector<WorkPatch> patches;  ///< in tree order; patches[k].patch is the index in the mesh
  std::vector<Cluster> clusters;   ///< parents before children
  int root = 0;
  Vec3 centre;       ///< working = (x - centre) * scale
  double scale = 1;  ///< a power of two [1/m]
  /// Patches of the mesh before this one are the scene's, whose rows count; the others are its sky, among
  /// which nothing is exchanged.
  int sky_begin = 0;
};

/// Coplanarity, as a share of the scene: two patches lie in one plane when their corners do within this times
/// the lever arm. Above the noise of files with 10 digits, far below any gap that is meant.
constexpr double coplanar_tolerance = 1e-9;

/// Points nearer to a plane than this, in working coordinates, are on it: 1e4 roundings of a coordinate.
constexpr double plane_tolerance = 1e-12;

/// Cost: O(N log N).
ClusterTree cluster_tree(const PatchMesh& mesh);

/// Whether some point of a's patches may lie in front of some patch of b and the other way round; false
/// proves that no light goes between them, but for patches whose normals differ by less than 1e-5, which
/// exchange less than 1e-9 of their light.
bool may_face(const Cluster& a, const Cluster& b);

/// Bounds of the heights of b's points above the planes of a's patches, for planar clusters exact up to
/// `thickness`: low >= -plane_tolerance proves that all of b lies in front of all of a.
Span heights_over(const Cluster& a, const Cluster& b);

}  // namespace luxel
