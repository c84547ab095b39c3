// The whole road: a mesh or scene file in, its light out. Run it as: road room.obj room.csv
#include <exception>
#include <iostream>

#include <luxel/dense_operator.h>
#include <luxel/form_factors.h>
#include <luxel/mesh_scene.h>
#include <luxel/read_scene.h>
#include <luxel/solve.h>
#include <luxel/write_csv.h>

namespace {

void light_up(const char* scene_file, const char* csv_file) {
  // [road]
  const luxel::PatchMesh mesh = luxel::mesh_scene(luxel::read_scene(scene_file));
  const luxel::Enclosures enclosures = luxel::find_enclosures(mesh, luxel::RayScene(mesh.occluders));
  luxel::FormFactors factors = luxel::form_factors(mesh, {.accuracy = 1e-3});
  const auto closed = luxel::close_rows(std::move(factors.exchange_areas), mesh.areas, enclosures);
  const auto light = luxel::solve(*closed.transport, luxel::reflectance(mesh), luxel::emission(mesh));
  luxel::write_csv(csv_file, mesh, light);
  // [road]
  std::cout << mesh.size() << " patches, " << light.report.iterations << " iterations, residual "
            << light.report.relative_residual << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: road SCENE CSV\n";
    return 2;
  }
  try {
    light_up(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::cerr << "road: " << error.what() << '\n';
    return 1;
  }
}
