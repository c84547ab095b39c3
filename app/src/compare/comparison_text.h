#pragma once

#include <string>
#include <vector>

#include "compare/compare_solvers.h"

namespace luxel::compare {

/// A comparison as its readers want it.
struct Comparison {
  std::string scene;
  Reference reference;
  std::vector<Run> runs;  ///< each operator's solvers, three right-hand sides
  std::vector<Run>
      more_columns;  ///< the same solvers with other numbers of right-hand sides, for work-precision
};

/// The table for a terminal: a line a run, then the cheapest solver for each target error.
std::string to_table(const Comparison& comparison);

/// One JSON document, keys as documented in docs/command_line.md; numbers that are not finite become null.
std::string to_json(const Comparison& comparison);

/// A line for every point of every run's history.
std::string to_csv(const Comparison& comparison);

/// A page that stands alone: the two plots (SVG) and the tables.
std::string to_html(const Comparison& comparison, const std::string& svg);

}  // namespace luxel::compare
