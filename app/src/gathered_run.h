#pragma once

#include <string>

#include "commands.h"

namespace luxel::app {

/// What of a command gathering cannot do, with what it needs; empty: it can.
std::string gather_cannot(const SolveCommand& command);

}  // namespace luxel::app
