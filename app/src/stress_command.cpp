#include <cstdio>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "interruption.h"
#include "luxel/input_error.h"
#include "luxel/write_file.h"
#include "output_files.h"
#include "run_command.h"
#include "stress/run_stress.h"
#include "stress/stress_text.h"
#include "suggestion.h"

namespace luxel::app {

namespace {

// CPU time that one solver may take on one case; what a well-conditioned case takes is under a hundredth of
// it.
constexpr double seconds_each = 1.0;

constexpr Method all_methods[] = {Method::cholesky,
                                  Method::lu,
                                  Method::cg,
                                  Method::gmres,
                                  Method::neumann,
                                  Method::gauss_seidel,
                                  Method::symmetric_gauss_seidel,
                                  Method::southwell};

std::vector<stress::StressCase> chosen_cases(const std::vector<std::string>& names) {
  std::vector<stress::StressCase> all = stress::stress_cases(), chosen;
  if (names.empty()) return all;
  std::vector<std::string> known;
  for (const auto& each : all) known.push_back(each.name);
  for (const std::string& name : names) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) {
      throw InputError(fmt::format("stress: unknown case '{}'{} (expected {})", name, suggestion(name, known),
                                   fmt::join(known, ", ")));
    }
    chosen.push_back(all[found - known.begin()]);
  }
  return chosen;
}

}  // namespace

ExitStatus run(const StressCommand& command) {
  const std::vector<std::string> extensions = {".csv", ".json"};
  check_outputs(command.outputs, extensions, "");
  const std::vector<Method> methods =
      command.methods.empty() ? std::vector(std::begin(all_methods), std::end(all_methods)) : command.methods;

  std::vector<stress::CaseVerdicts> results;
  bool all_allowed = true;
  for (const stress::StressCase& each : chosen_cases(command.cases)) {
    if (interruption_requested()) throw Cancelled();
    results.push_back(stress::run_case(each, methods, seconds_each));
    for (const auto& run : results.back().solvers) all_allowed = all_allowed && run.allowed;
  }

  for (const std::string& file : command.outputs) {
    write_file(file, extension_of(file) == ".csv" ? stress::to_csv(results) : stress::to_json(results));
  }
  if (command.general.json) {
    std::fputs(stress::to_json(results).c_str(), stdout);
  } else if (!command.general.quiet) {
    std::fputs(stress::to_table(results).c_str(), stdout);
  }
  return all_allowed ? done : not_reached;
}

}  // namespace luxel::app
