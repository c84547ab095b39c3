#include "luxel/write_vtk.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "display_colours.h"
#include "extension.h"
#include "luxel/input_error.h"
#include "luxel/view.h"
#include "luxel/write_file.h"
#include "module.h"
#include "vtk_document.h"

namespace luxel {

namespace fs = std::filesystem;

namespace {

constexpr const char* flux_unit = "W/m^2";
constexpr const char* radiance_unit = "W/(m^2 sr)";

std::span<const double> values(const PatchField& field) {
  return {field.data(), static_cast<std::size_t>(field.size())};
}

void require_shape(const PatchField& field, std::size_t rows, const char* what) {
  if (static_cast<std::size_t>(field.rows()) != rows || field.cols() != 3) {
    throw std::invalid_argument(std::string("write_vtk: ") + what + " is not " + std::to_string(rows) +
                                " x 3");
  }
}

/// The values that documents of one mesh view: kept while they are written.
struct Content {
  PatchField emission, reflectance;
  const PatchField& vertex_radiosity;
  std::vector<double> luminance;
};

// Where a view of the scene is taken from, so that a script can show it from there
void add_camera(std::vector<VtkArray>& fields, const Camera& camera) {
  const auto add = [&](const char* name, const Vec3& x) {
    fields.push_back({name, std::vector<double>(x.data(), x.data() + 3), 3, "m", true});
  };
  add("view_eye", camera.eye);
  add("view_target", camera.target);
  add("view_up", camera.up);
  fields.push_back({"view_fov", std::vector<double>{camera.fov}, 1, "degrees"});
}

VtkDocument document(const PatchMesh& mesh, const GouraudMesh& gouraud, const PatchField& radiosity,
                     const ToneMap& tone_map, const Content& content) {
  VtkDocument result;
  result.points = gouraud.vertices;
  result.offsets = {0};
  for (const auto& corners : gouraud.corners) {
    for (const int corner : corners) {
      if (corner >= 0) result.connectivity.push_back(corner);
    }
    result.offsets.push_back(static_cast<long long>(result.connectivity.size()));
  }
  result.cell_arrays = {{"radiosity", values(radiosity), 3, flux_unit},
                        {"emission", values(content.emission), 3, flux_unit},
                        {"reflectance", values(content.reflectance), 3, "1"},
                        {"luminance", std::span<const double>(content.luminance), 1, radiance_unit},
                        {"material_id", std::span<const int>(mesh.materials), 1, ""},
                        {"group_id", std::span<const int>(mesh.groups), 1, ""},
                        {"display_rgb", display_colours(radiosity, tone_map), 3, ""}};
  result.point_arrays = {{"radiosity_vertex", values(content.vertex_radiosity), 3, flux_unit},
                         {"display_rgb", display_colours(content.vertex_radiosity, tone_map), 3, ""}};
  result.field_arrays = {{"material_names", mesh.material_names, 1, ""},
                         {"group_names", mesh.group_names, 1, ""},
                         {"display_exposure", std::vector<double>{tone_map.exposure}, 1, ""},
                         {"units",
                          std::vector<std::string>{"coordinates: m", "radiosity, irradiance, emission: W/m^2",
                                                   "luminance: W/(m^2 sr)", "reflectance, row_sum_error: 1",
                                                   "emitted, absorbed, escaped: W"},
                          1, ""}};
  add_camera(result.field_arrays, view_camera(mesh));
  result.active_cell_scalars = "luminance";
  return result;
}

void add_report(std::vector<VtkArray>& fields, const Report& report) {
  const auto add = [&](const char* name, double value, const char* unit = "") {
    if (std::isfinite(value)) fields.push_back({name, std::vector<double>{value}, 1, unit});
  };
  const auto add_text = [&](const char* name, const std::string& text) {
    fields.push_back({name, std::vector<std::string>{text}, 1, ""});
  };
  const auto add_channels = [&](const char* name, const std::array<double, 3>& values) {
    fields.push_back({name, std::vector<double>(values.begin(), values.end()), 3, "W"});
  };
  add_text("luxel_version", report.run.version);
  if (report.partial) add("partial", 1);
  add_text("scene", report.scene.file);
  add("area", report.scene.area, "m^2");
  add("closed", report.scene.closed);
  if (report.transport) {
    add_text("operator", report.transport->kind);
    add("accuracy", report.transport->accuracy);
    add("row_sum_error_max", report.transport->row_sum_error_max);
    add("row_sum_error_rms", report.transport->row_sum_error_rms);
  }
  if (report.solver) {
    add_text("solver", report.solver->method);
    add("converged", report.solver->converged);
    add("iterations", report.solver->iterations);
    add("relative_residual", report.solver->relative_residual);
    add("error_bound", report.solver->error_bound);
  }
  if (report.energy) {
    add_channels("emitted", report.energy->emitted);
    add_channels("absorbed", report.energy->absorbed);
    add_channels("escaped", report.energy->escaped);
    add("imbalance", report.energy->imbalance);
  }
  if (report.error) {
    add("operator_error", report.error->operator_estimate);
    add("operator_error_low", report.error->operator_low);
    add("operator_error_high", report.error->operator_high);
  }
}

Content content_of(const PatchMesh& mesh, const GouraudMesh& gouraud, const PatchField& radiosity,
                   const PatchField& vertex_radiosity) {
  require_shape(radiosity, mesh.corners.size(), "radiosity");
  require_shape(vertex_radiosity, gouraud.vertices.size(), "vertex_radiosity");
  return {emission(mesh), reflectance(mesh), vertex_radiosity, luminances(radiosity)};
}

std::string xml_escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&') {
      result += "&amp;";
    } else if (c == '<') {
      result += "&lt;";
    } else if (c == '"') {
      result += "&quot;";
    } else {
      result += c;
    }
  }
  return result;
}

void write_document(const fs::path& path, const VtkDocument& document) {
  const auto writer = *static_cast<const VtkWriter*>(module_symbol("luxel_vtk", vtk_writer_symbol, path));
  OutputFile file(path);
  const std::string reason = writer(document, file.working_path().string());
  if (!reason.empty()) throw InputError(path.string() + ": cannot be written: " + reason);
  file.commit();
}

}  // namespace

void write_vtk(const fs::path& path, const PatchMesh& mesh, const GouraudMesh& gouraud,
               const RadiositySolution& solution, const PatchField& vertex_radiosity,
               const VtkOptions& options) {
  require_shape(solution.irradiance, mesh.corners.size(), "irradiance");
  if (!options.row_sum_error.empty() && options.row_sum_error.size() != mesh.areas.size()) {
    throw std::invalid_argument("write_vtk: row_sum_error is not one number per patch");
  }
  const std::string extension = output_extension(path, {".vtp", ".vtu"});
  const Content content = content_of(mesh, gouraud, solution.radiosity, vertex_radiosity);
  VtkDocument result =
      document(mesh, gouraud, solution.radiosity, tone_map_for(mesh, content.luminance), content);
  result.unstructured = extension == ".vtu";
  result.cell_arrays.push_back({"irradiance", values(solution.irradiance), 3, flux_unit});
  if (!options.row_sum_error.empty()) {
    result.cell_arrays.push_back({"row_sum_error", options.row_sum_error, 1, "1"});
  }
  if (options.report) add_report(result.field_arrays, *options.report);
  write_document(path, result);
}

VtkSeries::VtkSeries(fs::path path, const PatchMesh& mesh, const GouraudMesh& gouraud)
    : path_(std::move(path)), mesh_(mesh), gouraud_(gouraud) {
  output_extension(path_, {".pvd"});
  OutputFile probe(path_);
}

void VtkSeries::add(double time, const PatchField& radiosity, const PatchField& vertex_radiosity) {
  const Content content = content_of(mesh_, gouraud_, radiosity, vertex_radiosity);
  const ToneMap tone_map = tone_map_ ? *tone_map_ : tone_map_for(mesh_, content.luminance);
  if (!tone_map_) {
    double lit = 0;
    for (int i = 0; i < mesh_.size(); ++i) lit += content.luminance[i] > 0 ? mesh_.areas[i] : 0;
    if (lit > total_area(mesh_) / 2) tone_map_ = tone_map;
  }
  VtkDocument step = document(mesh_, gouraud_, radiosity, tone_map, content);
  step.field_arrays.push_back({"TimeValue", std::vector<double>{time}, 1, ""});
  times_.push_back(time);
  write_document(path_.parent_path() / step_name(times_.size() - 1), step);
  write_list();
}

std::string VtkSeries::step_name(std::size_t step) const {
  std::array<char, 24> number;
  std::snprintf(number.data(), number.size(), "_%04zu.vtp", step);
  return path_.stem().string() + number.data();
}

void VtkSeries::write_list() const {
  std::string text =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      "  <Collection>\n";
  for (std::size_t step = 0; step < times_.size(); ++step) {
    std::array<char, 32> time;
    std::snprintf(time.data(), time.size(), "%.17g", times_[step]);
    text.append("    <DataSet timestep=\"").append(time.data());
    text.append("\" part=\"0\" file=\"").append(xml_escaped(step_name(step))).append("\"/>\n");
  }
  write_file(path_, text + "  </Collection>\n</VTKFile>\n");
}

}  // namespace luxel
