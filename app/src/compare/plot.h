#pragma once

#include <string>
#include <vector>

#include "compare/compare_solvers.h"

namespace luxel::compare {

enum class TimeAxis { cpu, wall };

/// The two plots of a comparison, drawn by gnuplot without a display: error against run time (log-log, the
/// error bound dashed) and relative residual against iteration.
/// @param terminal  "svg" or "png"
/// @returns the picture's bytes
/// @throws InputError if gnuplot is not installed or fails; the message says which.
std::string plot(const std::vector<Run>& runs, TimeAxis axis, const std::string& terminal);

}  // namespace luxel::compare
