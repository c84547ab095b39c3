#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace luxel {

/// A JSON value that knows the line on which it stands.
struct JsonValue {
  enum class Kind { Null, Boolean, Number, String, Array, Object };

  Kind kind = Kind::Null;
  int line = 0;  ///< from 1: where the value begins; for an object's member, where its key stands
  bool boolean = false;
  double number = 0;
  std::string text;
  std::vector<JsonValue> elements;                         ///< of an array
  std::vector<std::pair<std::string, JsonValue>> members;  ///< of an object, in the order of the file

  /// The member with this key, or null.
  const JsonValue* member(std::string_view key) const;

  /// "a number", "an array", ...
  std::string_view kind_name() const;
};

/// The JSON document in a text; comments (`//` and `/* */`) are allowed.
/// @throws InputError with file and line if it is not JSON, a key stands twice in an object, or values are
/// nested deeper than 64 levels.
JsonValue json_tree(const std::filesystem::path& file, std::string_view text);

}  // namespace luxel
