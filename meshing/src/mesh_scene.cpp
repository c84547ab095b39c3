#include "luxel/mesh_scene.h"

#include <cmath>
#include <stdexcept>

#include "as_is.h"
#include "facets.h"
#include "luxel/input_error.h"
#include "mesh_quality.h"
#include "occluders.h"
#include "patch_builder.h"

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

void refuse_too_many(const Scene& scene, double count, int limit) {
  if (count <= limit) return;
  throw InputError((scene.file.empty() ? "" : scene.file + ": ") + "about " +
                   std::to_string(static_cast<long long>(count)) +
                   " patches would result, expected at most " + std::to_string(limit));
}

}  // namespace

PatchMesh mesh_scene(const Scene& scene, const MeshingOptions& options, const Progress& progress) {
  check(options);
  validate(scene);
  tell(progress, 0);
  const Facets facets = make_facets(scene);
  refuse_too_many(scene, static_cast<double>(count_patches(facets)), options.max_patches);
  PatchMesh mesh = empty_mesh(scene);
  mesh.warnings.insert(mesh.warnings.end(), facets.warnings.begin(), facets.warnings.end());
  FacetOccluders blocking = make_occluders(facets);
  mesh.occluders = std::move(blocking.occluders);
  append_facets(mesh, scene, facets, blocking.polygon_of_facet);
  measure_quality(mesh, facets);
  tell(progress, 1);
  return mesh;
}

}  // namespace luxel
