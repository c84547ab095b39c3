#include "plan/error_bar.h"

#include <algorithm>

#include "plan/cost_model.h"

namespace luxel {

OperatorErrorOptions error_bar_options(const PatchMesh& mesh, const PlanOptions& options, double seconds) {
  const double patches = mesh.size(), triangles = static_cast<double>(mesh.occluders.triangles.size());
  OperatorErrorOptions probing;
  probing.accuracy = options.form_factors.accuracy;
  probing.seed = options.form_factors.seed;
  const double affordable = error_bar_share * (mesh_seconds(patches) + seconds) - probes_seconds(patches);
  probing.most_rays = std::max(0.0, affordable) / probe_ray_seconds(patches, triangles);
  return probing;
}

}  // namespace luxel
