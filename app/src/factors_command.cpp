#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

#include "assembly.h"
#include "luxel/group_factors.h"
#include "luxel/input_error.h"
#include "luxel/write_factors.h"
#include "luxel/write_file.h"
#include "output_files.h"
#include "progress_bar.h"
#include "reporting.h"
#include "run_command.h"
#include "shortfall.h"
#include "usage.h"

namespace luxel::app {

namespace {

const std::vector<std::string> extensions = {".mtx", ".csv", ".h5", ".json"};

// Groups that have a patch, and where in mesh.group_names they stand.
std::vector<int> groups_in_use(const PatchMesh& mesh) {
  std::vector<int> used = mesh.groups;
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  return used;
}

Report::GroupFactors between_groups(const PatchMesh& mesh, const DenseOperator& transport) {
  const GroupFactors all =
      group_form_factors(transport, mesh.groups, static_cast<int>(mesh.group_names.size()));
  const std::vector<int> used = groups_in_use(mesh);
  Report::GroupFactors figures;
  for (const int i : used) {
    figures.groups.push_back(mesh.group_names[i]);
    figures.areas.push_back(all.areas[i]);
    std::vector<double>& row = figures.form_factors.emplace_back();
    for (const int j : used) row.push_back(all.form_factors(i, j));
    figures.open.push_back(1 - all.form_factors.row(i).sum());
  }
  return figures;
}

Report::PointFactors from_point(const PatchMesh& mesh, const std::array<double, 6>& numbers) {
  const Vec3 point(numbers[0], numbers[1], numbers[2]);
  const Vec3 normal = Vec3(numbers[3], numbers[4], numbers[5]).normalized();
  const PointFactors all = point_to_groups(mesh, point, normal);
  Report::PointFactors figures;
  for (int k = 0; k < 3; ++k) {
    figures.point[k] = point[k];
    figures.normal[k] = normal[k];
  }
  for (const int i : groups_in_use(mesh)) {
    figures.groups.push_back(mesh.group_names[i]);
    figures.form_factors.push_back(all.form_factors[i]);
  }
  figures.open = all.open;
  figures.error = all.error;
  return figures;
}

void write(const FactorsCommand& command, const Assembly& assembly, const Progress& progress) {
  for (const std::string& file : command.outputs) {
    if (extension_of(file) == ".json") continue;
    write_factors(file, *assembly.transport, {.full_precision = command.full_precision}, progress);
  }
}

}  // namespace

ExitStatus run(const FactorsCommand& command) {
  const Stopwatch watch;
  check_outputs(command.outputs, extensions, command.scene.file);
  if (!command.transport.save.empty()) check_output(command.transport.save, command.scene.file);
  Report report = new_report("factors");
  ProgressBar bar(!command.general.quiet);
  const Progress progress = std::ref(bar);

  bool reached = true;
  // a point alone needs no factors between patches
  if (command.point && !command.by_group && command.outputs.empty() && command.transport.save.empty()) {
    const PatchMesh mesh = read_and_mesh(command.scene, command.general, progress, report);
    report.point_factors = from_point(mesh, *command.point);
  } else {
    const Assembly assembly =
        assemble(command.scene, command.transport, command.general, std::nullopt, progress, report);
    if (command.by_group) report.group_factors = between_groups(assembly.mesh, *assembly.transport);
    if (command.point) report.point_factors = from_point(assembly.mesh, *command.point);
    write(command, assembly, progress);
    const std::string inaccurate = accuracy_shortfall(assembly, true);
    reached = inaccurate.empty();
    if (!reached) report.scene.warnings.push_back(inaccurate);
  }
  add_run_figures(report, watch);
  for (const std::string& file : command.outputs) {
    if (extension_of(file) == ".json") write_file(file, to_json(report));
  }
  show(report, command.general, command.outputs);
  return reached ? done : not_reached;
}

}  // namespace luxel::app
