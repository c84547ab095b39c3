#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "luxel/scene.h"
#include "luxel/vector.h"

namespace luxel {

/// The scene's surfaces merged into as few flat polygons as possible, cut into triangles: what rays are
/// traced against and what hides one patch from another. Sheets that coincide stand once. Both sides block.
struct Occluders {
  std::vector<Vec3> vertices;  ///< [m]
  std::vector<std::array<int, 3>>
      triangles;              ///< indices into `vertices`, counter-clockwise seen from the front
  std::vector<int> polygons;  ///< for each triangle the flat polygon that it is part of, from 0
  int polygon_count = 0;
  std::vector<std::array<int, 2>> coplanar;  ///< polygons that overlap in one plane, ascending pairs
};

/// What meshing did and how good the patches are; printed by `luxel inspect` and `luxel solve`.
struct MeshReport {
  double min_angle = 0;          ///< smallest corner angle of a patch [degrees]
  double one_percent_angle = 0;  ///< smallest angle that 99 % of the patches exceed [degrees]
  double sharpest_input_angle =
      0;  ///< smallest corner of an input polygon [degrees]: min_angle cannot be above it
  double max_aspect =
      0;  ///< largest (longest edge) / (in-radius), scaled so that regular triangles and squares have 1
  double area_error = 0;   ///< relative difference between the area of the patches and of the scene
  double edge_length = 0;  ///< target edge length [m]; 0 for as-is
  int welded_vertices = 0;
  int repaired_t_junctions = 0;
  int remaining_t_vertices = 0;  ///< between neighbours that share an edge; 0 is the goal
  int imprinted_edges = 0;       ///< contact edges cut into the polygon that they lie on
  int degenerate_faces = 0;      ///< of zero area: no patch
  int duplicate_faces = 0;       ///< same corners and same side: merged
  int overlapping_faces = 0;     ///< that an earlier face covers in part, in the same plane on the same side
  double overlap_area = 0;  ///< the parts covered [m2]: cut away, but for as_is, where light counts twice
  int split_faces = 0;      ///< not a flat convex triangle or quad: split
};

/// Flat convex patches, each a triangle or a quad, with what the solver needs of them. Immutable once made.
struct PatchMesh {
  std::string file;
  std::vector<Vec3> vertices;  ///< [m]
  std::vector<std::array<int, 4>>
      corners;                  ///< N; indices into `vertices`, counter-clockwise; [3] = -1: a triangle
  std::vector<Vec3> normals;    ///< N unit vectors, front side
  std::vector<Vec3> centroids;  ///< N area centroids [m]
  std::vector<double> areas;    ///< N, > 0 [m2]
  std::vector<int> faces;       ///< N: the input face, counted from 0 in file order
  std::vector<int> groups;      ///< N indices into `group_names`
  std::vector<int> materials;   ///< N indices into `material_names`
  std::vector<int> finishes;    ///< N indices into `finish_table`
  std::vector<int> polygons;    ///< N: the flat polygon of `occluders` that the patch lies in
  std::vector<std::string> group_names;
  std::vector<std::string> material_names;
  std::vector<Finish> finish_table;
  Occluders occluders;
  std::optional<Camera> camera;
  MeshReport report;
  std::vector<std::string> warnings;  ///< the scene's and the mesher's own, one sentence each

  int size() const { return static_cast<int>(corners.size()); }
  int corner_count(int patch) const { return corners[patch][3] < 0 ? 3 : 4; }
};

/// Emission E on every patch, N x 3 [W/m2].
PatchField emission(const PatchMesh& mesh);

/// Reflectance rho of every patch, N x 3, in [0, 1].
PatchField reflectance(const PatchMesh& mesh);

/// Total area [m2].
double total_area(const PatchMesh& mesh);

/// A 64-bit fingerprint of the patches' geometry (vertices, corners, order) and of the occluders: equal for
/// equal meshes, whatever their materials. A saved operator carries it.
std::uint64_t geometry_hash(const PatchMesh& mesh);

}  // namespace luxel
