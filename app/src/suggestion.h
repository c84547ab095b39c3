#pragma once

#include <span>
#include <string>
#include <string_view>

namespace luxel::app {

/// "; did you mean 'NAME'?" with the candidate nearest to what was typed; nothing where there is no
/// candidate.
std::string suggestion(std::string_view typed, std::span<const std::string> candidates);

}  // namespace luxel::app
