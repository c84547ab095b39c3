#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace luxel {

/// The candidate that takes the fewest keystrokes to reach from `name` (insert, delete, replace or swap a
/// letter; a capital for its small letter costs half), the first of equals; nothing where there is no
/// candidate. For "did you mean" in messages. Cost: length of `name` times length of all candidates.
std::optional<std::string> nearest_name(std::string_view name, std::span<const std::string> candidates);

}  // namespace luxel
