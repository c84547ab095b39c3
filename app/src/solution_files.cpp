#include "solution_files.h"

#include <algorithm>

#include "interruption.h"
#include "luxel/input_error.h"
#include "luxel/write_csv.h"
#include "luxel/write_file.h"
#include "luxel/write_ply.h"
#include "output_files.h"

namespace luxel::app {

std::vector<std::string> solution_extensions() {
  return {".vtp", ".vtu", ".pvd", ".csv", ".json", ".ply"};
}

SolutionFiles::SolutionFiles(const SolveCommand& command, const Assembly& assembly)
    : command_(command), assembly_(assembly) {
  if (any({".vtp", ".vtu", ".pvd", ".ply"})) gouraud_ = gouraud_mesh(assembly.mesh);
  for (const std::string& file : command.outputs) {
    if (extension_of(file) != ".pvd") continue;
    series_.push_back(std::make_unique<VtkSeries>(file, assembly.mesh, gouraud_));
  }
}

bool SolutionFiles::any(std::initializer_list<const char*> extensions) const {
  return std::any_of(command_.outputs.begin(), command_.outputs.end(), [&](const std::string& file) {
    return std::find(extensions.begin(), extensions.end(), extension_of(file)) != extensions.end();
  });
}

void SolutionFiles::add_step(const Iteration& iteration) {
  if (series_.empty() || !iteration.radiosity) return;
  const PatchField vertex_radiosity = interpolate_to_vertices(assembly_.mesh, gouraud_, *iteration.radiosity);
  for (const auto& series : series_) series->add(iteration.number, *iteration.radiosity, vertex_radiosity);
}

void SolutionFiles::write(const RadiositySolution& solution, const Report& report, const Progress& progress) {
  const PatchMesh& mesh = assembly_.mesh;
  PatchField vertex_radiosity;
  if (any({".vtp", ".vtu", ".ply"})) {
    vertex_radiosity = interpolate_to_vertices(mesh, gouraud_, solution.radiosity);
  }
  double done = 0;
  for (const std::string& file : command_.outputs) {
    if (!progress("writing", done++, static_cast<double>(command_.outputs.size()))) throw Cancelled();
    const std::string extension = extension_of(file);
    if (extension == ".csv") {
      write_csv(file, mesh, solution, {.full_precision = command_.full_precision});
    } else if (extension == ".json") {
      write_file(file, to_json(report));
    } else if (extension == ".ply") {
      write_ply(file, mesh, gouraud_, vertex_radiosity);
    } else if (extension != ".pvd") {
      write_vtk(file, mesh, gouraud_, solution, vertex_radiosity,
                {.row_sum_error = assembly_.rows.of_patch, .report = &report});
    }
  }
}

}  // namespace luxel::app
