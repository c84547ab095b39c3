#include "luxel/mesh_scene.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>

#include "as_is.h"
#include "cut_overlaps.h"
#include "edge_table.h"
#include "facets.h"
#include "luxel/input_error.h"
#include "mesh_quality.h"
#include "occluders.h"
#include "patch_builder.h"
#include "patch_limit.h"
#include "sized.h"
#include "t_junctions.h"

namespace luxel {

namespace {

void check(const MeshingOptions& options) {
  if (!(options.patch_size >= 0) || !std::isfinite(options.patch_size)) {
    throw std::invalid_argument("patch_size must be a finite number of metres >= 0");
  }
  if (options.patches < 0) throw std::invalid_argument("patches must be >= 0");
  if (options.as_is + (options.patch_size > 0) + (options.patches > 0) > 1) {
    throw std::invalid_argument("at most one of as_is, patch_size and patches may be set");
  }
  if (!(options.crease_angle > 0 && options.crease_angle <= 180)) {
    throw std::invalid_argument("crease_angle must be in (0, 180] degrees");
  }
  if (options.max_patches < 1) throw std::invalid_argument("max_patches must be >= 1");
}

void tell(const Progress& progress, double done) {
  if (progress && !progress("meshing", done, 1)) throw Cancelled();
}

/// Whether the faces become patches unchanged: asked for, or because the input is finer than what is asked.
bool keeps_faces(const MeshingOptions& options, std::size_t face_patches,
                 std::vector<std::string>& warnings) {
  if (options.as_is) return true;
  if (options.patch_size > 0) return false;
  const int wanted = options.patches > 0 ? options.patches : MeshingOptions::default_patches;
  if (face_patches <= static_cast<std::size_t>(wanted)) return false;
  if (options.patches > 0) {
    warnings.push_back("the faces give " + std::to_string(face_patches) +
                       " patches as they are, more than the " + std::to_string(wanted) +
                       " asked for; they are kept, since faces are never merged into larger patches");
  }
  return true;
}

/// Facets made to meet corner to corner, and what of them blocks light.
struct Surface {
  std::optional<RepairedFacets> repaired;  ///< nothing: they did so before
  std::optional<EdgeTable> edges;          ///< of the repaired facets, else of the facets
  FacetOccluders blocking;
};

Surface make_surface(const Facets& facets) {
  Surface surface;
  surface.edges.emplace(facets.loops, static_cast<int>(facets.vertices.size()));
  surface.repaired = repair_t_junctions(facets, *surface.edges);
  const Facets& conforming = surface.repaired ? surface.repaired->facets : facets;
  if (surface.repaired) {
    surface.edges.emplace(conforming.loops, static_cast<int>(conforming.vertices.size()));
  }
  surface.blocking = make_occluders(conforming, *surface.edges);
  return surface;
}

std::string overlap_warning(const CutFacets& cut, bool kept) {
  std::array<char, 32> area;
  std::snprintf(area.data(), area.size(), "%.3g", cut.area);
  return std::to_string(cut.faces) + (cut.faces == 1 ? " face lies" : " faces lie") +
         " in part or all in the same plane and on the same side as an earlier one, by " + area.data() +
         " m2 (first: face " + std::to_string(cut.first_face) + " and face " +
         std::to_string(cut.first_above) + "); " +
         (kept ? "as-is keeps them, and light counts twice there"
               : "what the earlier one covers is cut away");
}

}  // namespace

PatchMesh mesh_scene(const Scene& scene, const MeshingOptions& options, const Progress& progress) {
  check(options);
  validate(scene);
  tell(progress, 0);
  const Facets facets = make_facets(scene);
  PatchMesh mesh = empty_mesh(scene);
  mesh.warnings.insert(mesh.warnings.end(), facets.warnings.begin(), facets.warnings.end());
  const std::size_t face_patches = count_patches(facets);
  const bool as_is = keeps_faces(options, face_patches, mesh.warnings);
  if (as_is) refuse_too_many(scene, static_cast<double>(face_patches), options.max_patches);

  Surface surface = make_surface(facets);
  std::optional<CutFacets> cut = cut_overlaps(facets, surface.blocking.regions, surface.blocking.overlaps);
  if (cut) {
    mesh.report.overlapping_faces = cut->faces;
    mesh.report.overlap_area = cut->area;
    mesh.warnings.push_back(overlap_warning(*cut, options.as_is));
    if (options.as_is) cut.reset();
  }
  if (cut) surface = make_surface(cut->facets);
  surface.blocking.regions = {};
  mesh.occluders = std::move(surface.blocking.occluders);
  const std::vector<int>& polygon_of_facet = surface.blocking.polygon_of_facet;
  const Facets& kept = cut ? cut->facets : facets;
  const std::optional<RepairedFacets>& repaired = surface.repaired;
  if (as_is) {
    surface.edges.reset();  // what is made now takes its memory
    append_facets(mesh, scene, kept, polygon_of_facet);
  } else {
    const Facets& conforming = repaired ? repaired->facets : kept;
    append_sized(mesh, scene, conforming, *surface.edges, polygon_of_facet, options, progress);
    if (repaired) mesh.report.repaired_t_junctions = repaired->repaired;
  }
  measure_patches(mesh);
  measure_quality(mesh, facets, cut ? cut->area : 0);
  // Patches that are the facets, none of which has a vertex on an edge, have none either.
  const bool found_before = as_is && !repaired && !cut && facets.split_faces == 0;
  mesh.report.remaining_t_vertices = found_before ? 0 : count_t_vertices(mesh);
  tell(progress, 1);
  return mesh;
}

}  // namespace luxel
