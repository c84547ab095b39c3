#include "run_command.h"

#include <cstdio>
#include <optional>

#include <tbb/global_control.h>

namespace luxel::app {

namespace {

ExitStatus run_with_threads(const auto& command) {
  std::optional<tbb::global_control> limit;
  if (command.general.threads > 0) {
    limit.emplace(tbb::global_control::max_allowed_parallelism, command.general.threads);
  }
  return run(command);
}

ExitStatus run_with_threads(const ShowText& command) {
  return run(command);
}

}  // namespace

ExitStatus run_command(const Command& command) {
  return std::visit([](const auto& chosen) { return run_with_threads(chosen); }, command);
}

ExitStatus run(const ShowText& command) {
  std::fputs(command.text.c_str(), stdout);
  return done;
}

}  // namespace luxel::app
