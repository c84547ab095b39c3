#pragma once

#include <array>
#include <span>
#include <vector>

#include "form_factors/cluster_tree.h"
#include "form_factors/polygon.h"
#include "form_factors/working_frame.h"
#include "luxel/patch_mesh.h"

namespace luxel {

/// Points nearer to an occluder's plane than this, in working coordinates, lie on it and are not hidden by
/// it: above the noise of files with 10 digits, a thousandth of the thinnest walls (1e-6).
constexpr double side_tolerance = 1e-10;

/// A flat convex polygon that hides what is on its other side.
struct OccluderFace {
  static constexpr int max_corners = 8;

  Polygon outline;  ///< counter-clockwise seen from the front
  Plane plane;
  std::array<Plane, max_corners> sides;  ///< of edge k: positive inside the outline, perpendicular to `plane`
  Vec3 centre;                           ///< of a sphere around the outline
  double radius = 0;
  int polygon = -1;  ///< in PatchMesh::occluders
};

/// An edge of a convex body, counter-clockwise seen from the front of `face`.
struct BodyEdge {
  Vec3 p, q;
  int face = 0;       ///< on the left, counted from the body's first
  int neighbour = 0;  ///< on the right
};

/// What hides as one: a single face, seen from both sides, or a closed convex body that nothing lies in or
/// touches, so that a line of sight which meets it enters by a face that it sees from the front. Bodies of
/// more than max_faces faces are *round*: their silhouette is found for every eye by itself.
struct Occluder {
  static constexpr int max_faces = 16;

  int begin = 0, end = 0;       ///< faces [begin, end) of OccluderSet::faces
  std::vector<BodyEdge> edges;  ///< of a body, each once; empty for a single face
  Vec3 centre;
  double radius = 0;
  bool idle = false;           ///< hides patches from the sky alone, for all else is on one side of it
  double inner_radius = 0;     ///< of a sphere around the centre inside a round body
  std::vector<Vec3> vertices;  ///< of a round body

  bool body() const { return !edges.empty(); }
  bool round() const { return face_count() > max_faces; }
  int face_count() const { return end - begin; }
};

/// On which side of a plane a round body lies, up to side_tolerance.
enum class Side { front, behind, both };
Side side_of_plane(const Occluder& round_body, const Plane& plane);

/// Everything that can hide one patch from another, in working coordinates.
struct OccluderSet {
  std::vector<OccluderFace> faces;
  std::vector<Occluder> occluders;
};

/// The occluders of a mesh: its flat polygons in convex pieces of at most eight corners, without those that
/// have nothing behind or nothing in front of them; closed convex bodies as one. Cost: faces times vertices
/// at worst, early exits in practice.
/// A tree with a sky keeps those that hide from the sky alone, marked.
/// @param keep_idle  also those that have nothing on one side
OccluderSet occluder_set(const PatchMesh& mesh, const WorkingFrame& frame, bool keep_idle = false);
OccluderSet occluder_set(const PatchMesh& mesh, const ClusterTree& tree, bool keep_idle = false);

/// A face of the outline with its sides and its sphere.
OccluderFace occluder_face(const Polygon& outline, const Plane& plane, int polygon);

/// Convex pieces, counter-clockwise, whose union is the triangles' (one flat polygon), as few as easily
/// found: the whole where it is convex, else triangles joined over common edges as long as they stay convex.
/// Corners in the middle of straight edges are left out.
std::vector<Polygon> convex_pieces(std::span<const Vec3> vertices,
                                   std::span<const std::array<int, 3>> triangles, const Vec3& normal);

/// Joins faces that close around a convex body into one occluder each; the others stay single. A body that a
/// patch lies in, or touches with more than an edge, is left as single faces; so is a round one that shares a
/// vertex with anything else.
std::vector<Occluder> join_bodies(std::vector<OccluderFace>& faces, const PatchMesh& mesh,
                                  const WorkingFrame& frame);

}  // namespace luxel
