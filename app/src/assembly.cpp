#include "assembly.h"

#include <algorithm>
#include <cmath>

#include "luxel/mesh_scene.h"
#include "luxel/read_scene.h"
#include "memory_plan.h"
#include "usage.h"

namespace luxel::app {

namespace {

template <class Real>
void add_rows(const ExchangeMatrix& exchange, std::vector<double>& sums) {
  for (int i = 1; i < exchange.size(); ++i) {
    const Real* row = exchange.row<Real>(i);
    double sum = 0;
    for (int j = 0; j < i; ++j) {
      sum += row[j];
      sums[j] += row[j];
    }
    sums[i] += sum;
  }
}

RowErrors row_errors(const ExchangeMatrix& exchange, const std::vector<double>& areas,
                     const Enclosures& enclosures) {
  RowErrors errors;
  errors.of_patch.assign(areas.size(), 0.0);
  if (exchange.precision() == Precision::float32) {
    add_rows<float>(exchange, errors.of_patch);
  } else {
    add_rows<double>(exchange, errors.of_patch);
  }
  double total = 0;
  for (std::size_t i = 0; i < areas.size(); ++i) {
    double& error = errors.of_patch[i];
    error = std::abs(error / areas[i] + enclosures.open_share[i] + enclosures.back_share[i] - 1);
    const double certain = std::max(0.0, error - 3 * enclosures.share_error[i]);
    errors.max = std::max(errors.max, error);
    errors.certain_max = std::max(errors.certain_max, certain);
    errors.rms += areas[i] * error * error;
    errors.certain_rms += areas[i] * certain * certain;
    total += areas[i];
  }
  errors.rms = std::sqrt(errors.rms / total);
  errors.certain_rms = std::sqrt(errors.certain_rms / total);
  return errors;
}

}  // namespace

PatchMesh read_and_mesh(const SceneOptions& options, const GeneralOptions& general, const Progress& progress,
                        Report& report) {
  const ReadOptions reading = {options.emission_is_exitance ? EmissionUnit::Exitance
                                                            : EmissionUnit::Radiance};
  const Scene scene = read_scene(options.file, reading);
  report.scene.file = options.file;
  report.scene.faces = scene.face_count();
  report.scene.vertices = static_cast<std::int64_t>(scene.vertices.size());
  report.scene.materials = static_cast<std::int64_t>(scene.materials.size());
  check_memory(mesh_bytes(options.meshing.patches), general.memory, options.meshing.patches);
  PatchMesh mesh = mesh_scene(scene, options.meshing, progress);
  report.patches = mesh.size();
  report.scene.area = total_area(mesh);
  report.scene.warnings = mesh.warnings;
  return mesh;
}

Assembly assemble(const SceneOptions& scene, const FormFactorOptions& form_factors,
                  const GeneralOptions& general, Method method, const Progress& progress, Report& report) {
  Assembly assembly;
  assembly.mesh = read_and_mesh(scene, general, progress, report);
  const PatchMesh& mesh = assembly.mesh;

  FormFactorOptions options = form_factors;
  options.precision = storage_precision(mesh.size(), options.accuracy);
  check_memory(solve_bytes(mesh.size(), options.precision, method), general.memory, mesh.size());

  const Stopwatch watch;
  assembly.enclosures = find_enclosures(mesh, RayScene(mesh.occluders), 256, progress);
  FormFactors factors = luxel::form_factors(mesh, options, progress);
  assembly.form_factors = factors.report;
  assembly.rows = row_errors(factors.exchange_areas, mesh.areas, assembly.enclosures);
  assembly.closed = close_rows(std::move(factors.exchange_areas), mesh.areas, assembly.enclosures, progress);
  const Seconds seconds = watch.elapsed();

  report.scene.closed = assembly.enclosures.closed;
  report.scene.enclosures = assembly.enclosures.count;
  Report::Operator figures;
  figures.kind = assembly.closed.transport->kind();
  figures.accuracy = options.accuracy;
  figures.bytes = assembly.closed.transport->bytes();
  figures.rays = assembly.enclosures.rays + assembly.form_factors.rays;
  figures.cpu_seconds = seconds.cpu;
  figures.wall_seconds = seconds.wall;
  figures.row_sum_error_max = assembly.rows.max;
  figures.row_sum_error_rms = assembly.rows.rms;
  figures.reciprocity_error = 0;  // each pair is stored once, A_i F_ij and A_j F_ji are the same number
  if (assembly.closed.closure.applied) figures.correction = "symmetric scaling";
  figures.largest_correction = assembly.closed.closure.largest_correction;
  report.transport = figures;
  return assembly;
}

}  // namespace luxel::app
