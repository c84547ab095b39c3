#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "luxel/form_factors.h"
#include "luxel/mesh_scene.h"
#include "luxel/solve.h"

namespace luxel::app {

/// What every command takes.
struct GeneralOptions {
  bool json = false;       ///< exactly one JSON document on stdout instead of the summary
  bool quiet = false;      ///< no summary, progress or warnings
  int threads = 0;         ///< 0: as many as the machine runs at once
  std::size_t memory = 0;  ///< most bytes to take; 0: what the machine has
};

/// What is read and how it is cut into patches.
struct SceneOptions {
  std::string file;
  bool emission_is_exitance = false;  ///< what a mesh file calls emission: E instead of radiance E / pi
  MeshingOptions meshing;
};

/// luxel solve
struct SolveCommand {
  GeneralOptions general;
  SceneOptions scene;
  FormFactorOptions form_factors;
  SolveOptions solve;
  std::vector<std::string> outputs;
  bool full_precision = false;
  std::string save, load;
};

/// luxel factors
struct FactorsCommand {
  GeneralOptions general;
  SceneOptions scene;
  FormFactorOptions form_factors;
  std::vector<std::string> outputs;
  bool by_group = false;
  bool raw = false;
  std::vector<std::array<double, 6>> points;  ///< x, y, z and the normal's three
  std::string save, load;
};

/// luxel inspect
struct InspectCommand {
  GeneralOptions general;
  SceneOptions scene;
};

/// --help, --version: a text for stdout, and nothing else to do.
struct ShowText {
  std::string text;
};

using Command = std::variant<ShowText, SolveCommand, FactorsCommand, InspectCommand>;

}  // namespace luxel::app
