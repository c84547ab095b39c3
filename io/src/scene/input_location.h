#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace luxel {

/// A place in a file of the user's.
struct InputLocation {
  std::filesystem::path file;
  int line = 0;  ///< from 1; 0: the file as a whole
};

/// "file:line: message" on one line, whatever control characters the file's own words bring along.
/// @throws InputError always.
[[noreturn]] void refuse(const InputLocation& where, std::string_view message);

/// A word of the user's in quotes, cut where it is very long.
std::string in_quotes(std::string_view word);

/// `; nearest: "x"`, or nothing without candidates: the end of a message about an unknown name.
std::string nearest_hint(std::string_view name, const std::vector<std::string>& candidates);

/// "1 face", "2 faces".
std::string counted(std::size_t count, std::string_view noun);

/// `"a", "b", "c" and 4 more`.
std::string listed(const std::vector<std::string>& names);

}  // namespace luxel
