#pragma once

#include <vector>

#include "commands.h"
#include "luxel/dense_operator.h"
#include "luxel/enclosures.h"
#include "luxel/report.h"

namespace luxel::app {

/// How far the raw row of each patch is from what it should be.
struct RowErrors {
  /// N: |s_i + open_i + back_i - 1|, open and back measured by rays of their own.
  std::vector<double> of_patch;
  double max = 0;          ///< largest magnitude
  double rms = 0;          ///< area-weighted
  double certain_max = 0;  ///< largest magnitude beyond three standard errors of the measured shares
  double certain_rms = 0;  ///< the same, area-weighted root mean square
};

/// Patches with their transport operator, ready to be solved or written.
struct Assembly {
  PatchMesh mesh;
  Enclosures enclosures;
  ClosedOperator closed;
  RowErrors rows;  ///< before any correction
  FormFactorReport form_factors;
};

/// The first half of the road: reads the scene, cuts it into patches, computes their form factors and closes
/// the rows; fills in report.scene, patches and transport. `method` is what will solve it, for the memory
/// estimate.
/// @throws InputError, Cancelled
Assembly assemble(const SceneOptions& scene, const FormFactorOptions& form_factors,
                  const GeneralOptions& general, Method method, const Progress& progress, Report& report);

/// Reads and meshes only; fills in report.scene (but for closed and enclosures) and patches.
PatchMesh read_and_mesh(const SceneOptions& options, const GeneralOptions& general, const Progress& progress,
                        Report& report);

}  // namespace luxel::app
