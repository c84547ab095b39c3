#include "reporting.h"

#include <cstdio>

#include <fmt/format.h>
#include <tbb/global_control.h>

#include "factor_tables.h"

namespace luxel::app {

Report new_report(const std::string& command) {
  Report report;
  report.run.version = LUXEL_VERSION;
  report.run.command = command;
  report.run.threads =
      static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
  return report;
}

void add_run_figures(Report& report, const Stopwatch& since_start) {
  report.cpu_seconds = process_cpu_seconds();
  report.wall_seconds = since_start.elapsed().wall;
  report.peak_bytes = peak_bytes();
}

void show(const Report& report, const GeneralOptions& general, const std::vector<std::string>& written) {
  if (!general.quiet) {
    for (const std::string& warning : report.scene.warnings) {
      std::fprintf(stderr, "luxel: warning: %s\n", warning.c_str());
    }
  }
  if (general.json) {
    std::fputs(to_json(report).c_str(), stdout);
  } else if (!general.quiet) {
    Report without_warnings = report;  // they are on stderr already
    without_warnings.scene.warnings.clear();
    std::fputs(summary(without_warnings).c_str(), stdout);
    std::fputs(factor_tables(report).c_str(), stdout);
    for (const std::string& file : written) fmt::print("wrote        {}\n", file);
  }
}

}  // namespace luxel::app
