#pragma once

#include "commands.h"
#include "exit_status.h"

namespace luxel::app {

/// Runs the command, each in a file of its own: solve_command.cpp, inspect_command.cpp, factors_command.cpp.
ExitStatus run_command(const Command& command);

ExitStatus run(const ShowText& command);
ExitStatus run(const SolveCommand& command);
ExitStatus run(const FactorsCommand& command);
ExitStatus run(const InspectCommand& command);

}  // namespace luxel::app
