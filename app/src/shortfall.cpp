#include "shortfall.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace luxel::app {

namespace {

int worst_row(const RowErrors& rows) {
  int worst = -1;
  for (int i = 0; i < static_cast<int>(rows.of_patch.size()); ++i) {
    if (std::isnan(rows.of_patch[i])) continue;
    if (worst < 0 || rows.of_patch[i] > rows.of_patch[worst]) worst = i;
  }
  return worst;
}

std::string row_shortfall(const Assembly& assembly) {
  const RowErrors& rows = assembly.rows;
  std::string text =
      fmt::format("row sums are off by {:.2g} (RMS, {:.2g} of it beyond chance)", rows.rms, rows.certain_rms);
  const int patch = worst_row(rows);
  if (patch < 0) return text + fmt::format(", at most by {:.2g}", rows.max);
  const PatchMesh& mesh = assembly.mesh;
  const Vec3& at = mesh.centroids[patch];
  return text +
         fmt::format(", most that of patch {} (face {}, material \"{}\", at {:.3g} {:.3g} {:.3g}), by {:.2g}",
                     patch, mesh.faces[patch], mesh.material_names[mesh.materials[patch]], at.x(), at.y(),
                     at.z(), rows.of_patch[patch]);
}

}  // namespace

std::string accuracy_shortfall(const Assembly& assembly, bool largest_too) {
  if (accuracy_reached(assembly, largest_too)) return {};
  const double accuracy = assembly.record.options.accuracy;
  std::vector<std::string> parts;
  if (assembly.operator_error && assembly.operator_error->surely_above(accuracy)) {
    parts.push_back(fmt::format("the operator's error is {:.2g} ({:.2g} to {:.2g})",
                                assembly.operator_error->estimate, assembly.operator_error->low,
                                assembly.operator_error->high));
  }
  if (assembly.record.closure.unclosed >= 0) {
    parts.push_back(
        fmt::format("the enclosure of patch {} was not closed", assembly.record.closure.unclosed));
  }
  // what is left that can have missed it, and what often goes with the others
  if (parts.empty() || assembly.rows.certain_rms > accuracy) parts.push_back(row_shortfall(assembly));
  return fmt::format("the accuracy asked, {:.2g}, was not reached: {}", accuracy, fmt::join(parts, "; "));
}

std::string solver_shortfall(const SolveReport& solved, const SolveOptions& asked) {
  if (solved.converged || solved.stopped == Stopped::bounces) return {};
  const std::string wanted = asked.error ? fmt::format("an error bound of {:.2g}", *asked.error)
                                         : fmt::format("a relative residual of {:.2g}", asked.tolerance);
  return fmt::format("the solver did not converge to {}: after {} iteration{} the residual is {:.2g}", wanted,
                     solved.iterations, solved.iterations == 1 ? "" : "s", solved.relative_residual) +
         (std::isfinite(solved.error_bound) ? fmt::format(" and the error bound {:.2g}", solved.error_bound)
                                            : "");
}

}  // namespace luxel::app
