#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "assembly.h"
#include "commands.h"
#include "luxel/gouraud.h"
#include "luxel/report.h"
#include "luxel/solve.h"
#include "luxel/write_vtk.h"

namespace luxel::app {

/// The extensions that a solution can be written with, with their dots.
std::vector<std::string> solution_extensions();

/// The files that a solve was asked for: time series grow while it runs, the others are written at its end.
class SolutionFiles {
 public:
  /// The assembly must outlive it.
  SolutionFiles(const SolveCommand& command, const Assembly& assembly);

  /// One more step for every time series.
  void add_step(const Iteration& iteration);

  /// The files asked for, as they are called: of a partial report with ".partial" before the extension, time
  /// series as they are.
  std::vector<std::string> names(const Report& report) const;

  /// Writes all but the time series and the report.
  /// @throws InputError naming the file that could not be written; Cancelled before the next file
  void write(const RadiositySolution& solution, const Report& report, const Progress& progress);

  /// Writes the report's own files (.json), for after everything that it measures.
  void write_report(const Report& report) const;

 private:
  bool any(std::initializer_list<const char*> extensions) const;

  const SolveCommand& command_;
  const Assembly& assembly_;
  GouraudMesh gouraud_;  ///< empty where no file needs it
  std::vector<std::unique_ptr<VtkSeries>> series_;
};

}  // namespace luxel::app
