#pragma once

#include <cstddef>
#include <optional>

#include "luxel/exchange_matrix.h"
#include "luxel/solve.h"

namespace luxel::app {

/// Memory that reading and cutting a scene into so many patches takes, about [bytes].
std::size_t mesh_bytes(int patches);

/// Memory that a dense operator of so many patches, and solving it by the method if there is one, will take
/// at its peak, about [bytes].
std::size_t solve_bytes(int patches, Precision precision, std::optional<Method> method);

/// What --memory allows, or where it was not given (0) what the machine has [bytes].
std::size_t memory_limit(std::size_t limit);

/// @param limit  bytes that may be taken; 0: what the machine has
/// @throws InputError with the estimate where it is above the limit
void check_memory(std::size_t estimate, std::size_t limit, int patches);

}  // namespace luxel::app
