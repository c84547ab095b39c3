#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "luxel/scene.h"
#include "luxel/solve.h"
#include "luxel/transport_operator.h"

namespace luxel::stress {

enum class Verdict {
  exact,    ///< within the case's tolerance
  bounded,  ///< error <= error_bound, and error_bound <= 1e-2 unless a budget stopped the run
  refused,  ///< no result, the cause named
  failed    ///< all else
};

enum class ExpectationKind {
  value,     ///< known numbers on some patches
  bounds,    ///< known to lie between two numbers
  singular,  ///< no solution, or no unique one
  limit      ///< the value that a limit of the geometry or of the reflectance tends to
};

/// What theory says of one patch.
struct PatchValue {
  int patch = 0;
  double low = 0;   ///< [W/m2]
  double high = 0;  ///< [W/m2]; equal to low for a value
};

struct Expectation {
  ExpectationKind kind = ExpectationKind::value;
  std::vector<PatchValue> radiosity;  ///< channel 0; patches not named are not checked
  double tolerance = 1e-9;            ///< of error: max |B - B*| / max |B*| over the patches named
  std::string tolerance_reason;
  std::string source;
};

/// A system to solve: one channel, with what keeps it alive.
struct Problem {
  std::shared_ptr<const TransportOperator> transport;
  PatchField reflectance;  ///< N x 1
  PatchField emission;     ///< N x 1
};

/// One stiff or extreme case. To add one more: append it in the file of its kind (furnace, geometry,
/// algebra).
struct StressCase {
  std::string name;  ///< snake_case, unique
  std::string what;  ///< one sentence
  Expectation expected;
  std::vector<Verdict> allowed;      ///< what a solver may come to
  std::function<Problem()> problem;  ///< builds mesh and operator
  double tolerance = 1e-12;          ///< relative residual asked of the solvers
};

/// The system of a scene by the usual road: as-is patches, form factors to 1e-8, closed rows in float64.
Problem problem_of(const Scene& scene, bool single_precision = false);

/// The same value on each patch of a mesh of `count` patches.
std::vector<PatchValue> everywhere(int count, double value);

std::vector<StressCase> furnace_cases();
std::vector<StressCase> geometry_cases();
std::vector<StressCase> algebra_cases();

/// All of them, in that order.
std::vector<StressCase> stress_cases();

}  // namespace luxel::stress
