#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "commands.h"
#include "luxel/operator_error.h"
#include "luxel/operator_file.h"
#include "luxel/report.h"
#include "usage.h"

namespace luxel::app {

/// How far the raw row of each patch is from what it should be.
struct RowErrors {
  /// N: |s_i + open_i + back_i - 1|, open from form factors of the sky, by rays where backs are seen.
  std::vector<double> of_patch;
  double max = 0;          ///< largest magnitude
  double rms = 0;          ///< area-weighted
  double certain_max = 0;  ///< largest magnitude beyond what chance may do to the shares
  double certain_rms = 0;  ///< the same, area-weighted root mean square
};

/// Patches with their transport operator, ready to be solved or written.
struct Assembly {
  PatchMesh mesh;
  std::unique_ptr<DenseOperator> transport;
  OperatorRecord record;  ///< how the operator came about, in this run or in the one that saved it
  RowErrors rows;         ///< before any correction; of_patch is empty where it was loaded or gathered
  std::optional<OperatorError> operator_error;  ///< where it was estimated
};

/// The first half of the road: reads the scene, cuts it into patches, computes their form factors and closes
/// the rows, or loads the operator; saves it where asked. Fills in report.scene, patches and transport.
/// `method` is what will solve it, for the memory estimate.
/// @throws InputError, Cancelled
Assembly assemble(const SceneOptions& scene, const OperatorOptions& options, const GeneralOptions& general,
                  std::optional<Method> method, const Progress& progress, Report& report);

/// Raw row errors from raw row sums, N; patches whose row sum is not a number were not assembled and do not
/// count.
RowErrors row_errors(const std::vector<double>& row_sums, const std::vector<double>& areas,
                     const Enclosures& enclosures);

/// Fills in report.transport, and closed and enclosures of report.scene.
void report_operator(const Assembly& assembly, std::string_view kind, std::size_t bytes,
                     const Seconds& seconds, Report& report);

/// Whether the operator is as accurate as asked, as far as rays can tell: the low end of its error's interval
/// and the RMS error of the raw rows <= accuracy, and in `factors` the largest <= 2 accuracy.
bool accuracy_reached(const Assembly& assembly, bool largest_too);

/// Reads and meshes only; fills in report.scene (but for closed and enclosures) and patches.
PatchMesh read_and_mesh(const SceneOptions& options, const GeneralOptions& general, const Progress& progress,
                        Report& report);

}  // namespace luxel::app
