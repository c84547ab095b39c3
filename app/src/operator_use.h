#pragma once

#include <string>

#include "commands.h"

namespace luxel::app {

/// What of a command an operator cannot do, with what can; empty: it can.
std::string operator_cannot(OperatorKind kind, const SolveCommand& command);

}  // namespace luxel::app
