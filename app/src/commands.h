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
#include "luxel/plan.h"
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

/// How the transport operator comes about.
struct OperatorOptions {
  OperatorKind kind = OperatorKind::automatic;
  FormFactorOptions form_factors;
  bool accuracy_given = false;  ///< form_factors.accuracy was typed, not the default
  bool raw = false;             ///< rows are left as computed
  std::string save;             ///< file to keep the operator in; empty: none
  std::string load;             ///< file of a kept operator to use instead of computing one; empty: none
};

/// luxel solve
struct SolveCommand {
  GeneralOptions general;
  SceneOptions scene;
  OperatorOptions transport;
  SolveOptions solve;
  Savings savings;
  bool error_bar = true;      ///< estimate the operator's error
  bool keep_partial = false;  ///< what is solved when Ctrl-C comes is written, and says so
  std::vector<std::string> outputs;
  bool full_precision = false;
};

/// luxel factors
struct FactorsCommand {
  GeneralOptions general;
  SceneOptions scene;
  OperatorOptions transport;
  std::vector<std::string> outputs;
  bool full_precision = false;
  bool by_group = false;
  std::optional<std::array<double, 6>> point;  ///< x, y, z [m] and a normal's three components
};

/// luxel inspect
struct InspectCommand {
  GeneralOptions general;
  SceneOptions scene;
};

/// luxel compare
struct CompareCommand {
  GeneralOptions general;
  SceneOptions scene;
  OperatorOptions transport;
  std::vector<Method> methods;  ///< empty: all that the operator allows
  double tolerance = 1e-10;     ///< relative residual asked of each
  bool operators = false;       ///< also a coarser and a finer operator, and half and twice the patches
  bool wall_time = false;       ///< plots over wall time instead of CPU time
  std::string reference;        ///< a CSV of patches to measure against; empty: the best direct solve
  std::vector<std::string> outputs;
};

/// luxel stress
struct StressCommand {
  GeneralOptions general;
  std::vector<std::string> cases;  ///< by name; empty: all
  std::vector<Method> methods;     ///< empty: all
  std::vector<std::string> outputs;
};

/// --help, --version: a text for stdout, and nothing else to do.
struct ShowText {
  std::string text;
};

using Command =
    std::variant<ShowText, SolveCommand, FactorsCommand, InspectCommand, CompareCommand, StressCommand>;

}  // namespace luxel::app
