#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "luxel/vector.h"
#include "scene/json_tree.h"

namespace luxel {

/// A member of a scene file with where it stands, so that whatever is wrong with it can be told.
struct SceneValue {
  const std::filesystem::path& file;
  const JsonValue& json;
  std::string item;  ///< what messages call it, such as `camera.eye`
  std::string name;  ///< its own key, such as `eye`

  /// "file:line: item: message". @throws InputError always.
  [[noreturn]] void refuse(const std::string& message) const;

  /// The members of an object, as values of their own.
  /// @throws InputError if this is no object.
  std::vector<SceneValue> members() const;

  /// The member with this key. @throws InputError if there is none.
  SceneValue member(std::string_view key) const;

  /// @throws InputError if this is no object or has a key that is not one of these; the nearest is named.
  void allow_keys(std::initializer_list<std::string_view> keys) const;

  double number() const;
  bool boolean() const;
  std::string text() const;
  int whole_number(int least, int most) const;

  /// Three numbers.
  Vec3 vector() const;

  /// Three numbers, or one that stands for three equal ones; each in [least, most].
  Rgb colour(double least, double most, std::string_view range) const;
};

}  // namespace luxel
