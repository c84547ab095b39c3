#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace luxel::app {

// Texts of the command line to values. Each gives nothing where the text is not wholly one.

/// A finite number.
std::optional<double> parse_number(std::string_view text);

/// A whole number >= 0.
std::optional<std::uint64_t> parse_count(std::string_view text);

/// A memory size [bytes]: a number > 0 with an optional suffix K, M or G (powers of 1024), "300M" or "1.5G".
std::optional<std::size_t> parse_bytes(std::string_view text);

/// Six numbers with commas between: a point and a direction that is not zero.
std::optional<std::array<double, 6>> parse_point(std::string_view text);

/// "1.2 GiB": a memory size to read.
std::string readable_bytes(double bytes);

/// The same words with line breaks, so that no line is longer than `width` where words allow.
std::string wrapped(const std::string& text, std::size_t width);

}  // namespace luxel::app
