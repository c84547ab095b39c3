#include "suggestion.h"

#include "luxel/nearest_name.h"

namespace luxel::app {

std::string suggestion(std::string_view typed, std::span<const std::string> candidates) {
  const auto nearest = nearest_name(typed, candidates);
  return nearest ? "; did you mean '" + *nearest + "'?" : "";
}

}  // namespace luxel::app
