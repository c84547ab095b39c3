#pragma once

#include <string>

#include "compare/compare_solvers.h"

namespace luxel::compare {

/// Radiosities to measure against, from a CSV of patches as `luxel solve -o x.csv` writes it (columns B_r,
/// B_g, B_b).
/// @throws InputError with file and line if it cannot be read, lacks a column or has another number of
/// patches
Reference read_reference(const std::string& file, int patches);

}  // namespace luxel::compare
