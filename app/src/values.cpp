#include "values.h"

#include <charconv>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

namespace luxel::app {

namespace {

template <class Value>
std::optional<Value> parse_whole(std::string_view text) {
  Value value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  const auto value = parse_whole<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<std::uint64_t> parse_count(std::string_view text) {
  return parse_whole<std::uint64_t>(text);
}

std::optional<std::size_t> parse_bytes(std::string_view text) {
  if (text.empty()) return std::nullopt;
  double unit = 1;
  switch (text.back()) {
    case 'K':
    case 'k':
      unit = 0x1p10;
      break;
    case 'M':
    case 'm':
      unit = 0x1p20;
      break;
    case 'G':
    case 'g':
      unit = 0x1p30;
      break;
    default:
      break;
  }
  if (unit > 1) text.remove_suffix(1);
  const auto value = parse_number(text);
  if (!value || *value * unit < 1 || *value * unit >= 0x1p63) return std::nullopt;
  return static_cast<std::size_t>(*value * unit);
}

std::optional<std::array<double, 6>> parse_point(std::string_view text) {
  std::array<double, 6> numbers{};
  for (int k = 0; k < 6; ++k) {
    const std::size_t comma = text.find(',');
    if ((comma == std::string_view::npos) != (k == 5)) return std::nullopt;
    const auto value = parse_number(text.substr(0, comma));
    if (!value) return std::nullopt;
    numbers[k] = *value;
    if (k < 5) text.remove_prefix(comma + 1);
  }
  if (numbers[3] == 0 && numbers[4] == 0 && numbers[5] == 0) return std::nullopt;
  return numbers;
}

std::string readable_bytes(double bytes) {
  if (bytes >= 0x1p30) return fmt::format("{:.1f} GiB", bytes / 0x1p30);
  if (bytes >= 0x1p20) return fmt::format("{:.0f} MiB", bytes / 0x1p20);
  return fmt::format("{:.0f} KiB", bytes / 0x1p10);
}

std::string wrapped(const std::string& text, std::size_t width) {
  std::string result;
  std::size_t column = 0;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const bool breaks = column > 0 && column + 1 + word.size() > width;
    if (column > 0) result += breaks ? '\n' : ' ';
    column = breaks ? word.size() : column + (column > 0) + word.size();
    result += word;
  }
  return result;
}

}  // namespace luxel::app
