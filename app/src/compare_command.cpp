#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "assembly.h"
#include "compare/compare_solvers.h"
#include "compare/comparison_text.h"
#include "compare/plot.h"
#include "compare/reference_file.h"
#include "interruption.h"
#include "luxel/gather_operator.h"
#include "luxel/hierarchical_operator.h"
#include "luxel/input_error.h"
#include "luxel/write_file.h"
#include "output_files.h"
#include "progress_bar.h"
#include "reporting.h"
#include "run_command.h"

namespace luxel::app {

namespace {

// Light settings beside the scene's own, for the work-precision table: one, and ten sets of three channels.
constexpr int few_columns = 1, many_columns = 30;

// Operators by rays and by clusters are not asked for more than this: kept as a whole, gathered rays take 40
// kB a patch.
constexpr double finest_sampled = 1e-3;

// The scene's channels again and again, each time with other weights, so that no two right-hand sides are
// alike.
PatchField widened(const PatchField& values, int columns, bool weighted) {
  PatchField wide(values.rows(), columns);
  for (int k = 0; k < columns; ++k) {
    for (Eigen::Index i = 0; i < values.rows(); ++i) {
      const double weight = weighted && k >= 3 ? 1 + 0.5 * std::cos(static_cast<double>(k * (i + 1))) : 1;
      wide(i, k) = weight * values(i, k % values.cols());
    }
  }
  return wide;
}

compare::TimeAxis time_axis(const CompareCommand& command) {
  return command.wall_time ? compare::TimeAxis::wall : compare::TimeAxis::cpu;
}

std::string content(const std::string& extension, const compare::Comparison& comparison,
                    compare::TimeAxis axis) {
  if (extension == ".csv") return to_csv(comparison);
  if (extension == ".json") return to_json(comparison);
  if (extension == ".html") return to_html(comparison, compare::plot(comparison.runs, axis, "svg"));
  return compare::plot(comparison.runs, axis, extension.substr(1));
}

// What the solvers are run on: one operator, and the light that they look for.
struct ComparedSystem {
  const TransportOperator& transport;
  double accuracy;  // asked of the operator
  PatchField reflectance;
  PatchField emission;
  PatchField apart;  // radiosity that is known beforehand and comes on top; empty: none
};

compare::CompareOptions compare_options(const CompareCommand& command, const TransportOperator& transport) {
  compare::CompareOptions options;
  options.methods = compare::methods_for(transport);
  if (!command.methods.empty()) {
    std::erase_if(options.methods, [&](Method method) {
      return std::ranges::find(command.methods, method) == command.methods.end();
    });
  }
  options.tolerance = command.tolerance;
  options.stopped = [] { return interruption_requested(); };
  return options;
}

std::vector<compare::Run> runs_on(const ComparedSystem& system, const compare::Reference& reference,
                                  const CompareCommand& command) {
  std::vector<compare::Run> runs =
      compare::compare_solvers(system.transport, system.reflectance, system.emission, reference,
                               compare_options(command, system.transport));
  for (compare::Run& run : runs) run.accuracy = system.accuracy;
  return runs;
}

// All solvers on the scene's own system, and with other numbers of right-hand sides.
void add_first(compare::Comparison& comparison, const ComparedSystem& system, const CompareCommand& command) {
  comparison.reference =
      command.reference.empty()
          ? compare::reference_solution(system.transport, system.reflectance, system.emission)
          : compare::read_reference(command.reference, system.transport.size());
  comparison.runs = runs_on(system, comparison.reference, command);
  for (int columns : {few_columns, many_columns}) {
    const ComparedSystem wide = {system.transport,
                                 system.accuracy,
                                 widened(system.reflectance, columns, false),
                                 widened(system.emission, columns, true),
                                 {}};
    const std::vector<compare::Run> runs =
        runs_on(wide, compare::reference_solution(wide.transport, wide.reflectance, wide.emission), command);
    comparison.more_columns.insert(comparison.more_columns.end(), runs.begin(), runs.end());
  }
}

// The solvers on another operator, against its own solution, and how far that one is from the first's.
void add_other(compare::Comparison& comparison, const ComparedSystem& system, const CompareCommand& command) {
  const compare::Reference own =
      compare::reference_solution(system.transport, system.reflectance, system.emission);
  std::vector<compare::Run> runs = runs_on(system, own, command);
  const PatchField& first = comparison.reference.radiosity;
  if (own.radiosity.rows() == first.rows()) {
    const PatchField whole = system.apart.size() > 0 ? own.radiosity + system.apart : own.radiosity;
    for (compare::Run& run : runs) run.operator_error = compare::relative_error(whole, first);
  }
  comparison.runs.insert(comparison.runs.end(), runs.begin(), runs.end());
}

ComparedSystem system_of(const Assembly& assembly, double accuracy) {
  return {*assembly.transport, accuracy, reflectance(assembly.mesh), emission(assembly.mesh), {}};
}

// Gathered by rays, with the light straight from the lamps apart, as `solve` does it.
void add_gathered(compare::Comparison& comparison, const PatchMesh& mesh, const CompareCommand& command,
                  const Progress& progress) {
  GatherOptions options;
  options.accuracy = std::max(command.transport.form_factors.accuracy, finest_sampled);
  options.seed = command.transport.form_factors.seed;
  const RayScene occluders(mesh.occluders);
  const PatchField rho = reflectance(mesh), emitted = emission(mesh);
  const auto transport = gather_operator(mesh, occluders, options, progress);
  const DirectLight direct = direct_irradiance(mesh, occluders, emitted, options, progress);
  add_other(comparison, {*transport, options.accuracy, rho, rho.cwiseProduct(direct.irradiance), emitted},
            command);
}

void add_hierarchical(compare::Comparison& comparison, const Assembly& assembly,
                      const CompareCommand& command, const Progress& progress) {
  HierarchicalOptions options;
  options.accuracy = std::max(command.transport.form_factors.accuracy, finest_sampled);
  options.seed = command.transport.form_factors.seed;
  const PatchField rho = reflectance(assembly.mesh), emitted = emission(assembly.mesh);
  const auto transport =
      hierarchical_operator(assembly.mesh, assembly.record.enclosures, rho, emitted, options, progress);
  add_other(comparison, {*transport, options.accuracy, rho, emitted, {}}, command);
}

}  // namespace

ExitStatus run(const CompareCommand& command) {
  const std::vector<std::string> extensions = {".csv", ".json", ".html", ".png", ".svg"};
  check_outputs(command.outputs, extensions, command.scene.file);
  Report report = new_report("compare");
  ProgressBar bar(!command.general.quiet);

  // with --operators also operators by rays and by clusters, a coarser and a finer one, and half and twice
  // the patches
  compare::Comparison comparison;
  comparison.scene = command.scene.file;
  const Assembly assembly =
      assemble(command.scene, command.transport, command.general, Method::cholesky, std::ref(bar), report);
  const double accuracy = command.transport.form_factors.accuracy;
  const ComparedSystem first = system_of(assembly, accuracy);
  if ((first.emission.array() == 0).all()) {
    throw InputError(command.scene.file + ": nothing emits, nothing to compare");
  }
  add_first(comparison, first, command);
  if (command.operators) {
    add_gathered(comparison, assembly.mesh, command, std::ref(bar));
    add_hierarchical(comparison, assembly, command, std::ref(bar));
    for (double factor : {10.0, 0.1}) {
      OperatorOptions options = command.transport;
      options.form_factors.accuracy = std::clamp(accuracy * factor, 1e-8, 0.1);
      Report other = report;
      const Assembly again =
          assemble(command.scene, options, command.general, Method::cholesky, std::ref(bar), other);
      add_other(comparison, system_of(again, options.form_factors.accuracy), command);
    }
    for (double factor : {0.5, 2.0}) {
      SceneOptions scene = command.scene;
      scene.meshing.as_is = false;
      scene.meshing.patch_size = 0;
      scene.meshing.patches = static_cast<int>(factor * assembly.mesh.size());
      Report other = report;
      const Assembly resized =
          assemble(scene, command.transport, command.general, Method::cholesky, std::ref(bar), other);
      add_other(comparison, system_of(resized, accuracy), command);
    }
  }

  for (const std::string& file : command.outputs) {
    write_file(file, content(extension_of(file), comparison, time_axis(command)));
  }
  if (command.general.json) {
    std::fputs(to_json(comparison).c_str(), stdout);
  } else if (!command.general.quiet) {
    std::fputs(to_table(comparison).c_str(), stdout);
  }
  // a solver that ended neither converged nor by its budget did not do what was asked
  const bool all_ended = std::ranges::all_of(
      comparison.runs, [](const compare::Run& run) { return run.converged || run.stopped == "budget"; });
  return all_ended ? done : not_reached;
}

}  // namespace luxel::app
