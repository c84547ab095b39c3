#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "luxel/gouraud.h"
#include "luxel/patch_mesh.h"
#include "luxel/report.h"
#include "luxel/solve.h"
#include "luxel/tone_map.h"

namespace luxel {

/// What a VTK file can tell beside the solution.
struct VtkOptions {
  std::span<const double> row_sum_error = {};  ///< N; empty: the file has no such array
  const Report* report = nullptr;              ///< its main figures become field data; null: none
};

/// Writes the solved patches for ParaView: one cell per patch in patch order, points are the Gouraud
/// vertices. Arrays, units and field data: docs/outputs.md. The extension chooses: .vtp polygons, .vtu
/// unstructured grid. Numbers in float64, appended raw with lz4. Whole or not at all (OutputFile). Cost: 0.5
/// CPU seconds and 130 MB of memory for a million patches.
/// @throws InputError where the file cannot be written, has another extension, or the module luxel_vtk is
/// missing
/// @throws std::invalid_argument unless the fields have one row per patch and three columns
void write_vtk(const std::filesystem::path& path, const PatchMesh& mesh, const GouraudMesh& gouraud,
               const RadiositySolution& solution, const PatchField& vertex_radiosity,
               const VtkOptions& options = {});

/// A time series for ParaView, one step per bounce or iteration: a .pvd file that lists one .vtp beside it
/// for every step. The list is written anew after each step, so that what a stopped run leaves can be read.
/// Each step has radiosity, luminance, emission, reflectance and both kinds of display_rgb. The display
/// colours of all steps share one exposure, once more than half of the area is lit. The meshes must outlive
/// the series.
class VtkSeries {
 public:
  /// @throws InputError if the extension is not .pvd, or the folder cannot be written to
  VtkSeries(std::filesystem::path path, const PatchMesh& mesh, const GouraudMesh& gouraud);

  /// Writes `<name>_<number of the step>.vtp`, then the list.
  /// @param time              what ParaView shows as time: the bounce or iteration
  /// @param radiosity         N x 3 [W/m2]
  /// @param vertex_radiosity  V x 3 [W/m2], from interpolate_to_vertices
  void add(double time, const PatchField& radiosity, const PatchField& vertex_radiosity);

 private:
  std::string step_name(std::size_t step) const;
  void write_list() const;

  std::filesystem::path path_;
  const PatchMesh& mesh_;
  const GouraudMesh& gouraud_;
  std::vector<double> times_;
  std::optional<ToneMap> tone_map_;
};

}  // namespace luxel
