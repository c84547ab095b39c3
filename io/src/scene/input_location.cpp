#include "scene/input_location.h"

#include <algorithm>

#include "luxel/input_error.h"
#include "luxel/nearest_name.h"

namespace luxel {
namespace {

// A message stays readable on a terminal: longer words are cut, longer lists counted.
constexpr std::size_t longest_quote = 60;
constexpr std::size_t longest_list = 8;

}  // namespace

void refuse(const InputLocation& where, std::string_view message) {
  std::string text = where.file.string();
  if (where.line > 0) text.append(":").append(std::to_string(where.line));
  text += ": ";
  text += message;
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  throw InputError(text);
}

std::string in_quotes(std::string_view word) {
  std::string text = "\"";
  text += word.substr(0, longest_quote);
  if (word.size() > longest_quote) text += "...";
  return text + "\"";
}

std::string nearest_hint(std::string_view name, const std::vector<std::string>& candidates) {
  const std::optional<std::string> nearest = nearest_name(name.substr(0, longest_quote), candidates);
  return nearest ? "; nearest: " + in_quotes(*nearest) : "";
}

std::string counted(std::size_t count, std::string_view noun) {
  return std::to_string(count) + " " + std::string(noun) + (count == 1 ? "" : "s");
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), longest_list); ++i) {
    text += (i == 0 ? "" : ", ") + in_quotes(names[i]);
  }
  if (names.size() > longest_list) text += " and " + std::to_string(names.size() - longest_list) + " more";
  return text;
}

}  // namespace luxel
