#include "scene/scene_values.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "scene/input_location.h"

namespace luxel {
namespace {

using Kind = JsonValue::Kind;

std::string spelt(double number) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, number).ptr;
  return {digits, end};
}

[[noreturn]] void wrong_kind(const SceneValue& value, std::string_view expected) {
  value.refuse("found " + std::string(value.json.kind_name()) + "; expected " + std::string(expected));
}

}  // namespace

void SceneValue::refuse(const std::string& message) const {
  luxel::refuse({file, json.line}, item.empty() ? message : item + ": " + message);
}

std::vector<SceneValue> SceneValue::members() const {
  if (json.kind != Kind::Object) wrong_kind(*this, "an object {..}");
  std::vector<SceneValue> values;
  for (const auto& [key, value] : json.members) {
    values.push_back({file, value, item.empty() ? key : item + "." + key, key});
  }
  return values;
}

SceneValue SceneValue::member(std::string_view key) const {
  const JsonValue* value = json.member(key);
  if (!value) refuse("no " + in_quotes(key));
  return {file, *value, item.empty() ? std::string(key) : item + "." + std::string(key), std::string(key)};
}

void SceneValue::allow_keys(std::initializer_list<std::string_view> keys) const {
  for (const SceneValue& entry : members()) {
    if (std::find(keys.begin(), keys.end(), entry.name) != keys.end()) continue;
    const std::vector<std::string> known(keys.begin(), keys.end());
    luxel::refuse({file, entry.json.line}, (item.empty() ? "" : item + ": ") + "unknown key " +
                                               in_quotes(entry.name) + nearest_hint(entry.name, known));
  }
}

double SceneValue::number() const {
  if (json.kind != Kind::Number) wrong_kind(*this, "a number");
  return json.number;
}

bool SceneValue::boolean() const {
  if (json.kind != Kind::Boolean) wrong_kind(*this, "true or false");
  return json.boolean;
}

std::string SceneValue::text() const {
  if (json.kind != Kind::String) wrong_kind(*this, "a string");
  return json.text;
}

int SceneValue::whole_number(int least, int most) const {
  const double value = number();
  if (value != std::floor(value) || value < least || value > most) {
    refuse("found " + spelt(value) + "; expected a whole number from " + std::to_string(least) + " to " +
           std::to_string(most));
  }
  return static_cast<int>(value);
}

Vec3 SceneValue::vector() const {
  if (json.kind != Kind::Array) wrong_kind(*this, "three numbers [x, y, z]");
  if (json.elements.size() != 3)
    refuse("found " + counted(json.elements.size(), "value") + "; expected three");
  Vec3 v;
  for (int i = 0; i < 3; ++i) v[i] = SceneValue{file, json.elements[i], item, name}.number();
  return v;
}

Rgb SceneValue::colour(double least, double most, std::string_view range) const {
  if (json.kind != Kind::Array && json.kind != Kind::Number) wrong_kind(*this, "a number or [r, g, b]");
  const Rgb value = json.kind == Kind::Number ? Rgb(Rgb::Constant(json.number)) : Rgb(vector().array());
  for (const double channel : value) {
    if (!(channel >= least && channel <= most))
      refuse("found " + spelt(channel) + "; expected " + std::string(range));
  }
  return value;
}

}  // namespace luxel
