#pragma once

#include <exception>
#include <string>

namespace luxel::app {

/// What the program ends with.
enum ExitStatus : int {
  done = 0,
  not_reached = 1,     ///< finished and written, but what was asked was not reached
  unusable_input = 2,  ///< input, command line or memory; nothing was written
  internal_fault = 3,
  interrupted = 130  ///< stopped by Ctrl-C
};

/// How a command failed: the status and one line for the user, without a line break.
struct Failure {
  ExitStatus status = internal_fault;
  std::string message;
};

Failure describe_failure(std::exception_ptr thrown);

}  // namespace luxel::app
