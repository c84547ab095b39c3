#pragma once

#include <functional>
#include <string_view>

namespace luxel {

/// Told by every long stage how far it is: the stage's name, what is done of it and what it will be in total
/// (same unit, total > 0). Called from one thread at a time, at most a few hundred times a stage. Returning
/// false cancels: the stage throws Cancelled as soon as its running blocks end. An empty function is allowed:
/// nobody listens.
using Progress = std::function<bool(std::string_view stage, double done, double total)>;

}  // namespace luxel
