#pragma once

#include "commands.h"

namespace luxel::app {

/// What the user typed as one command with its options, all in range.
/// @throws InputError with one line that names the option, what was found and what was expected, and the
/// nearest name where one was mistyped.
Command parse_command_line(int argc, const char* const* argv);

}  // namespace luxel::app
