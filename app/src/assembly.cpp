#include "assembly.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "luxel/input_error.h"
#include "luxel/mesh_scene.h"
#include "luxel/plan.h"
#include "luxel/read_scene.h"
#include "memory_plan.h"
#include "usage.h"

namespace luxel::app {

namespace {

// Rays that measure anew what is seen of sky and backs, where backs are: so many in any case (under half a
// second), and one for so many pairs of patches in larger scenes.
constexpr std::int64_t least_share_rays = 2'000'000, pairs_a_share_ray = 16;

// Where rows of a closed scene turn out worse than asked, all is computed again for half the accuracy, so
// often.
constexpr int most_tries = 2;
constexpr double finest_accuracy = 1e-8;

bool within(const RowErrors& rows, double accuracy) {
  return rows.certain_rms <= accuracy && rows.certain_max <= 2 * accuracy;
}

void compute(Assembly& assembly, const FormFactorOptions& options, bool raw, const Progress& progress) {
  const PatchMesh& mesh = assembly.mesh;
  OperatorRecord& record = assembly.record;
  record.options = options;
  record.enclosures = planned_enclosures(mesh, {}, progress);
  FormFactorOptions how = options;
  how.sky_shares = !record.enclosures.closed;
  FormFactors factors = form_factors(mesh, how, progress);
  if (!record.enclosures.closed) {
    take_sky_shares(record.enclosures, factors.sky_shares, options.accuracy);
    const std::int64_t pairs = static_cast<std::int64_t>(mesh.size()) * mesh.size() / 2;
    measure_shares(record.enclosures, mesh, RayScene(mesh.occluders), options.accuracy,
                   std::max(least_share_rays, pairs / pairs_a_share_ray), 256, progress);
  }
  const auto measure = [&] {
    assembly.rows = row_errors(row_sums(factors.exchange_areas, mesh.areas), mesh.areas, record.enclosures);
  };
  measure();
  // in closed scenes the rows themselves tell whether the errors of pairs were what was expected of them
  FormFactorOptions tighter = options;
  for (int again = 0;
       again < most_tries && record.enclosures.closed && !within(assembly.rows, options.accuracy); ++again) {
    tighter.accuracy = std::max(tighter.accuracy / 2, finest_accuracy);
    factors.exchange_areas = ExchangeMatrix(0, options.precision);  // never two of them
    factors = form_factors(mesh, tighter, progress);
    measure();
  }
  record.form_factors = factors.report;
  if (raw) {
    assembly.transport = std::make_unique<DenseOperator>(std::move(factors.exchange_areas), mesh.areas);
    record.closure.before = record.closure.after = {assembly.rows.max, assembly.rows.rms};
  } else {
    ClosedOperator closed = close_rows(std::move(factors.exchange_areas), mesh.areas, record.enclosures,
                                       progress, most_correction * options.accuracy);
    assembly.transport = std::move(closed.transport);
    record.closure = closed.closure;
  }
}

void load(Assembly& assembly, const OperatorOptions& options, const Progress& progress) {
  SavedOperator saved = load_operator(options.load, assembly.mesh, progress);
  if (options.accuracy_given && saved.record.options.accuracy > options.form_factors.accuracy) {
    throw InputError(fmt::format("{}: found form factors of accuracy {}, expected {} or better (--accuracy)",
                                 options.load, saved.record.options.accuracy, options.form_factors.accuracy));
  }
  assembly.transport = std::move(saved.transport);
  assembly.record = std::move(saved.record);
  assembly.rows.max = assembly.record.closure.before.max;
  assembly.rows.rms = assembly.record.closure.before.rms;
}

}  // namespace

RowErrors row_errors(const std::vector<double>& row_sums, const std::vector<double>& areas,
                     const Enclosures& enclosures) {
  RowErrors errors;
  errors.of_patch = row_sums;
  double total = 0;
  for (std::size_t i = 0; i < areas.size(); ++i) {
    double& error = errors.of_patch[i];
    if (std::isnan(error)) continue;
    error = std::abs(error + enclosures.open_share[i] + enclosures.back_share[i] - 1);
    const double certain = std::max(0.0, error - largest_by_chance(enclosures, static_cast<int>(i)));
    errors.max = std::max(errors.max, error);
    errors.certain_max = std::max(errors.certain_max, certain);
    errors.rms += areas[i] * error * error;
    errors.certain_rms += areas[i] * certain * certain;
    total += areas[i];
  }
  if (total == 0) return errors;
  errors.rms = std::sqrt(errors.rms / total);
  errors.certain_rms = std::sqrt(errors.certain_rms / total);
  return errors;
}

void report_operator(const Assembly& assembly, std::string_view kind, std::size_t bytes,
                     const Seconds& seconds, Report& report) {
  const OperatorRecord& record = assembly.record;
  report.scene.closed = record.enclosures.closed;
  report.scene.enclosures = record.enclosures.count;
  if (!record.closure.message.empty()) report.scene.warnings.push_back(record.closure.message);
  Report::Operator figures;
  figures.kind = kind;
  figures.accuracy = record.options.accuracy;
  figures.bytes = bytes;
  figures.rays = record.enclosures.rays + record.form_factors.rays;
  figures.cpu_seconds = seconds.cpu;
  figures.wall_seconds = seconds.wall;
  figures.row_sum_error_max = assembly.rows.max;
  figures.row_sum_error_rms = assembly.rows.rms;
  figures.reciprocity_error = 0;  // each pair is stored once, A_i F_ij and A_j F_ji are the same number
  if (record.closure.applied) figures.correction = "symmetric scaling";
  figures.largest_correction = record.closure.largest_correction;
  report.transport = figures;
}

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
  report.scene.overlap_area = mesh.report.overlap_area;
  report.scene.overlapping_faces = mesh.report.overlapping_faces;
  report.scene.warnings = mesh.warnings;
  return mesh;
}

Assembly assemble(const SceneOptions& scene, const OperatorOptions& options, const GeneralOptions& general,
                  std::optional<Method> method, const Progress& progress, Report& report) {
  Assembly assembly;
  assembly.mesh = read_and_mesh(scene, general, progress, report);
  FormFactorOptions asked = options.form_factors;
  asked.precision = storage_precision(assembly.mesh.size(), asked.accuracy);
  check_memory(solve_bytes(assembly.mesh.size(), asked.precision, method), general.memory,
               assembly.mesh.size());

  const Stopwatch watch;
  if (options.load.empty()) {
    compute(assembly, asked, options.raw, progress);
  } else {
    load(assembly, options, progress);
  }
  report_operator(assembly, assembly.transport->kind(), assembly.transport->bytes(), watch.elapsed(), report);
  if (!options.save.empty()) {
    save_operator(options.save, assembly.mesh, *assembly.transport, assembly.record, progress);
  }
  return assembly;
}

bool accuracy_reached(const Assembly& assembly, bool largest_too) {
  const double accuracy = assembly.record.options.accuracy;
  if (assembly.operator_error && assembly.operator_error->surely_above(accuracy)) return false;
  if (assembly.record.closure.unclosed >= 0) return false;
  return assembly.rows.certain_rms <= accuracy && (!largest_too || assembly.rows.certain_max <= 2 * accuracy);
}

}  // namespace luxel::app
