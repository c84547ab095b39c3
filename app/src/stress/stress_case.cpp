#include "stress/stress_case.h"

#include "luxel/dense_operator.h"
#include "luxel/enclosures.h"
#include "luxel/form_factors.h"
#include "luxel/mesh_scene.h"

namespace luxel::stress {

namespace {

// Well under every tolerance of the cases that go through the geometry; with occluders the assembly says what
// it reached.
constexpr double case_accuracy = 1e-7;

}  // namespace

Problem problem_of(const Scene& scene, bool single_precision) {
  MeshingOptions meshing;
  meshing.as_is = true;
  const PatchMesh mesh = mesh_scene(scene, meshing);
  FormFactorOptions options;
  options.accuracy = case_accuracy;
  options.precision = single_precision ? Precision::float32 : Precision::float64;
  const Enclosures enclosures = find_enclosures(mesh, RayScene(mesh.occluders));
  Problem problem;
  problem.transport =
      close_rows(form_factors(mesh, options).exchange_areas, mesh.areas, enclosures).transport;
  problem.reflectance = reflectance(mesh).col(0);
  problem.emission = emission(mesh).col(0);
  return problem;
}

std::vector<PatchValue> everywhere(int count, double value) {
  std::vector<PatchValue> values;
  for (int i = 0; i < count; ++i) values.push_back({i, value, value});
  return values;
}

std::vector<StressCase> stress_cases() {
  std::vector<StressCase> all = furnace_cases();
  for (auto&& more : {geometry_cases(), algebra_cases()}) all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace luxel::stress
