#pragma once

#include <string>
#include <vector>

#include "stress/run_stress.h"

namespace luxel::stress {

/// A line a case: the verdict of each solver, and what was expected.
std::string to_table(const std::vector<CaseVerdicts>& cases);

/// One JSON document, keys as documented in docs/command_line.md; numbers that are not finite become null.
std::string to_json(const std::vector<CaseVerdicts>& cases);

/// A line for every case and solver.
std::string to_csv(const std::vector<CaseVerdicts>& cases);

}  // namespace luxel::stress
