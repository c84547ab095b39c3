#include "solution_files.h"

#include <algorithm>

#include "luxel/image.h"
#include "luxel/input_error.h"
#include "luxel/view.h"
#include "luxel/write_csv.h"
#include "luxel/write_file.h"
#include "luxel/write_ply.h"
#include "output_files.h"

namespace luxel::app {

std::vector<std::string> solution_extensions() {
  return {".vtp", ".vtu", ".pvd", ".csv", ".json", ".ply", ".exr", ".png", ".hdr"};
}

SolutionFiles::SolutionFiles(const SolveCommand& command, const Assembly& assembly)
    : command_(command), assembly_(assembly) {
  if (any({".vtp", ".vtu", ".pvd", ".ply", ".exr", ".png", ".hdr"})) gouraud_ = gouraud_mesh(assembly.mesh);
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

std::vector<std::string> SolutionFiles::names(const Report& report) const {
  std::vector<std::string> names = command_.outputs;
  for (std::string& file : names) {
    const std::size_t extension = extension_of(file).size();
    if (report.partial && extension_of(file) != ".pvd") file.insert(file.size() - extension, ".partial");
  }
  return names;
}

void SolutionFiles::write(const RadiositySolution& solution, const Report& report, const Progress& progress) {
  const PatchMesh& mesh = assembly_.mesh;
  PatchField vertex_radiosity;
  if (!gouraud_.vertices.empty()) {
    vertex_radiosity = interpolate_to_vertices(mesh, gouraud_, solution.radiosity);
  }
  Image view;
  if (any({".exr", ".png", ".hdr"})) {
    view = render_view(mesh, gouraud_, vertex_radiosity, view_camera(mesh), {}, progress);
  }
  double done = 0;
  for (const std::string& file : names(report)) {
    if (progress && !progress("writing", done++, static_cast<double>(command_.outputs.size())))
      throw Cancelled();
    const std::string extension = extension_of(file);
    if (extension == ".csv") {
      write_csv(file, mesh, solution, {.full_precision = command_.full_precision});
    } else if (extension == ".ply") {
      write_ply(file, mesh, gouraud_, vertex_radiosity);
    } else if (extension == ".exr" || extension == ".png" || extension == ".hdr") {
      write_image(file, view,
                  {.metadata = {{"Software", "luxel " LUXEL_VERSION}, {"luxel:scene", mesh.file}}});
    } else if (extension == ".vtp" || extension == ".vtu") {
      write_vtk(file, mesh, gouraud_, solution, vertex_radiosity,
                {.row_sum_error = assembly_.rows.of_patch, .report = &report});
    }
  }
}

void SolutionFiles::write_report(const Report& report) const {
  for (const std::string& file : names(report)) {
    if (extension_of(file) == ".json") write_file(file, to_json(report));
  }
}

}  // namespace luxel::app
