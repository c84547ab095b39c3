#pragma once

#include <string>
#include <vector>

#include "commands.h"
#include "luxel/report.h"
#include "usage.h"

namespace luxel::app {

/// A report that names the program, the command and the threads in use, and nothing else yet.
Report new_report(const std::string& command);

/// Fills in the run's own figures: CPU and wall seconds of the process, peak memory.
void add_run_figures(Report& report, const Stopwatch& since_start);

/// Tells the user how it went: warnings on stderr; on stdout the JSON document, or the summary with the files
/// that were written.
void show(const Report& report, const GeneralOptions& general, const std::vector<std::string>& written);

}  // namespace luxel::app
