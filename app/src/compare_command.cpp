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

// All solvers on the system of one assembly; with more_columns also for other numbers of right-hand sides.
void add_runs(compare::Comparison& comparison, const Assembly& assembly, const CompareCommand& command,
              double accuracy, bool first) {
  const TransportOperator& transport = *assembly.transport;
  const PatchField rho = reflectance(assembly.mesh), emitted = emission(assembly.mesh);
  if ((emitted.array() == 0).all())
    throw InputError(command.scene.file + ": nothing emits, nothing to compare");
  compare::CompareOptions options;
  options.methods = command.methods.empty() ? compare::methods_for(transport) : command.methods;
  options.tolerance = command.tolerance;
  options.stopped = [] { return interruption_requested(); };

  const compare::Reference reference = first && !command.reference.empty()
                                           ? compare::read_reference(command.reference, assembly.mesh.size())
                                           : compare::reference_solution(transport, rho, emitted);
  std::vector<compare::Run> runs = compare::compare_solvers(transport, rho, emitted, reference, options);
  for (compare::Run& run : runs) run.accuracy = accuracy;
  comparison.runs.insert(comparison.runs.end(), runs.begin(), runs.end());
  if (!first) return;
  comparison.reference = reference;
  for (int columns : {few_columns, many_columns}) {
    const PatchField wide_rho = widened(rho, columns, false), wide_emission = widened(emitted, columns, true);
    const compare::Reference wide = compare::reference_solution(transport, wide_rho, wide_emission);
    runs = compare::compare_solvers(transport, wide_rho, wide_emission, wide, options);
    for (compare::Run& run : runs) run.accuracy = accuracy;
    comparison.more_columns.insert(comparison.more_columns.end(), runs.begin(), runs.end());
  }
}

}  // namespace

ExitStatus run(const CompareCommand& command) {
  const std::vector<std::string> extensions = {".csv", ".json", ".html", ".png", ".svg"};
  check_outputs(command.outputs, extensions, command.scene.file);
  Report report = new_report("compare");
  ProgressBar bar(!command.general.quiet);

  // with --operators also a coarser and a finer operator, and half and twice the patches
  compare::Comparison comparison;
  comparison.scene = command.scene.file;
  const Assembly assembly =
      assemble(command.scene, command.transport, command.general, Method::cholesky, std::ref(bar), report);
  add_runs(comparison, assembly, command, command.transport.form_factors.accuracy, true);
  if (command.operators) {
    for (double factor : {10.0, 0.1}) {
      OperatorOptions options = command.transport;
      options.form_factors.accuracy = std::clamp(options.form_factors.accuracy * factor, 1e-8, 0.1);
      Report other = report;
      add_runs(comparison,
               assemble(command.scene, options, command.general, Method::cholesky, std::ref(bar), other),
               command, options.form_factors.accuracy, false);
    }
    for (double factor : {0.5, 2.0}) {
      SceneOptions scene = command.scene;
      scene.meshing.as_is = false;
      scene.meshing.patch_size = 0;
      scene.meshing.patches = static_cast<int>(factor * assembly.mesh.size());
      Report other = report;
      add_runs(comparison,
               assemble(scene, command.transport, command.general, Method::cholesky, std::ref(bar), other),
               command, command.transport.form_factors.accuracy, false);
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
