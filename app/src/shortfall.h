#pragma once

#include <string>

#include "assembly.h"
#include "luxel/solve.h"

namespace luxel::app {

/// One sentence that tells which accuracy was asked and by what it was missed; empty where
/// accuracy_reached().
std::string accuracy_shortfall(const Assembly& assembly, bool largest_too);

/// One sentence that tells what the solver was asked and did not reach; empty where it converged or did the
/// bounces asked.
std::string solver_shortfall(const SolveReport& solved, const SolveOptions& asked);

}  // namespace luxel::app
