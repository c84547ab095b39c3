#pragma once

#include "commands.h"
#include "exit_status.h"

namespace luxel::app {

/// Runs the command, each in a file of its own: solve_command.cpp, inspect_command.cpp ...
ExitStatus run_command(const Command& command);

ExitStatus run(const ShowText& command);
ExitStatus run(const SolveCommand& command);
ExitStatus run(const FactorsCommand& command);
ExitStatus run(const InspectCommand& command);
ExitStatus run(const CompareCommand& command);
ExitStatus run(const StressCommand& command);

}  // namespace luxel::app
