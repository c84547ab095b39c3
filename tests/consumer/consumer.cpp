// Lights the inside of a cube through the installed package. In a closed enclosure where every surface has
// the emission E and the reflectance rho, the radiosity is E / (1 - rho) everywhere (the white furnace).
#include <cmath>
#include <cstdio>

#include <luxel/dense_operator.h>
#include <luxel/form_factors.h>
#include <luxel/mesh_scene.h>
#include <luxel/solve.h>

int main() {
  luxel::Scene scene;
  scene.file = "cube";
  scene.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  const int quads[6][4] = {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1},
                           {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
  for (const auto& quad : quads) {
    scene.face_vertices.insert(scene.face_vertices.end(), quad, quad + 4);
    scene.face_offsets.push_back(static_cast<int>(scene.face_vertices.size()));
  }
  scene.groups = {"inside"};
  scene.materials = {"white"};
  luxel::Finish finish;
  finish.reflectance.setConstant(0.5);
  finish.emission.setOnes();
  scene.finishes = {finish};
  scene.face_groups = scene.face_materials = scene.face_finishes = std::vector<int>(6, 0);

  luxel::MeshingOptions meshing;
  meshing.as_is = true;
  const luxel::PatchMesh mesh = luxel::mesh_scene(scene, meshing);
  luxel::FormFactorOptions exact;
  exact.precision = luxel::Precision::float64;
  luxel::FormFactors factors = luxel::form_factors(mesh, exact);
  const luxel::Enclosures enclosures = luxel::find_enclosures(mesh, luxel::RayScene(mesh.occluders));
  const luxel::ClosedOperator closed =
      luxel::close_rows(std::move(factors.exchange_areas), mesh.areas, enclosures);
  const luxel::RadiositySolution light =
      luxel::solve(*closed.transport, luxel::reflectance(mesh), luxel::emission(mesh), {.tolerance = 1e-12});

  // rows sum to 1 within 1e-12 and the residual is below 1e-12: the error is a few times that
  const double error = (light.radiosity.array() - 2).abs().maxCoeff();
  std::printf("largest error of B = E / (1 - rho) in a cube: %.1e\n", error);
  return error < 1e-10 ? 0 : 1;
}
