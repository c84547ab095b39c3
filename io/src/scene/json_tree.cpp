#include "scene/json_tree.h"

#include <cstddef>
#include <iterator>
#include <nlohmann/json.hpp>

#include "scene/input_location.h"

namespace luxel {
namespace {

using nlohmann::json;

// No scene file needs more; bounds the recursion that frees the tree.
constexpr std::size_t deepest_nesting = 64;

// Where the parser has come to: nlohmann's events carry no position, so its input iterator counts.
struct Cursor {
  const char* begin;
  const char* position;
  const char* counted;
  int line = 1;

  // Line of the last character read. (After a number the parser has read one character too many; a line end
  // there still belongs to the number's line.)
  int line_here() {
    for (; counted + 1 < position; ++counted) line += *counted == '\n';
    return line;
  }
};

class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* position, Cursor* cursor) : position_(position), cursor_(cursor) {}
  reference operator*() const { return *position_; }
  CountingIterator& operator++() {
    cursor_->position = ++position_;
    return *this;
  }
  CountingIterator operator++(int) {
    CountingIterator before = *this;
    ++*this;
    return before;
  }
  bool operator==(const CountingIterator& other) const { return position_ == other.position_; }
  bool operator!=(const CountingIterator& other) const { return position_ != other.position_; }

 private:
  const char* position_;
  Cursor* cursor_;
};

// "[json.exception.parse_error.101] parse error at line 3, column 5: what" -> "what".
std::string what_is_wrong(std::string_view message) {
  constexpr std::string_view position_end = ": ";
  const std::size_t column = message.find("column ");
  const std::size_t start = message.find(position_end, column == std::string_view::npos ? 0 : column);
  if (column != std::string_view::npos && start != std::string_view::npos) {
    return std::string(message.substr(start + position_end.size()));
  }
  const std::size_t bracket = message.find("] ");
  return std::string(bracket == std::string_view::npos ? message : message.substr(bracket + 2));
}

class TreeBuilder : public nlohmann::json_sax<json> {
 public:
  TreeBuilder(const std::filesystem::path& file, Cursor& cursor) : file_(file), cursor_(cursor) {}

  JsonValue take_root() { return std::move(root_); }

  bool null() override { return place(value(JsonValue::Kind::Null)); }
  bool boolean(bool v) override {
    JsonValue node = value(JsonValue::Kind::Boolean);
    node.boolean = v;
    return place(std::move(node));
  }
  bool number_integer(number_integer_t v) override { return number(static_cast<double>(v)); }
  bool number_unsigned(number_unsigned_t v) override { return number(static_cast<double>(v)); }
  bool number_float(number_float_t v, const string_t&) override { return number(v); }
  bool string(string_t& v) override {
    JsonValue node = value(JsonValue::Kind::String);
    node.text = std::move(v);
    return place(std::move(node));
  }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(JsonValue::Kind::Object); }
  bool start_array(std::size_t) override { return open(JsonValue::Kind::Array); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    const int line = cursor_.line_here();
    if (const JsonValue* first = open_.back()->member(name)) {
      refuse({file_, line}, "key " + in_quotes(name) + " stands here a second time; first on line " +
                                std::to_string(first->line));
    }
    open_.back()->members.emplace_back(std::move(name), JsonValue{});
    open_.back()->members.back().second.line = line;
    return true;
  }

  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& error) override {
    refuse({file_, cursor_.line_here()}, "not JSON: " + what_is_wrong(error.what()));
  }

 private:
  JsonValue value(JsonValue::Kind kind) {
    JsonValue node;
    node.kind = kind;
    node.line = cursor_.line_here();
    return node;
  }

  bool number(double v) {
    JsonValue node = value(JsonValue::Kind::Number);
    node.number = v;
    return place(std::move(node));
  }

  JsonValue* put(JsonValue&& node) {
    if (open_.empty()) {
      root_ = std::move(node);
      return &root_;
    }
    JsonValue& parent = *open_.back();
    if (parent.kind == JsonValue::Kind::Array) return &parent.elements.emplace_back(std::move(node));
    JsonValue& member = parent.members.back().second;
    node.line = member.line;
    member = std::move(node);
    return &member;
  }

  bool place(JsonValue&& node) {
    put(std::move(node));
    return true;
  }

  bool open(JsonValue::Kind kind) {
    if (open_.size() == deepest_nesting) refuse({file_, cursor_.line_here()}, "nested deeper than 64 levels");
    open_.push_back(put(value(kind)));
    return true;
  }

  bool close() {
    open_.pop_back();
    return true;
  }

  std::filesystem::path file_;
  Cursor& cursor_;
  JsonValue root_;
  // The values being filled; only the last one grows, so the others stay where they are.
  std::vector<JsonValue*> open_;
};

}  // namespace

const JsonValue* JsonValue::member(std::string_view key) const {
  for (const auto& [name, value] : members) {
    if (name == key) return &value;
  }
  return nullptr;
}

std::string_view JsonValue::kind_name() const {
  switch (kind) {
    case Kind::Null:
      return "null";
    case Kind::Boolean:
      return "true or false";
    case Kind::Number:
      return "a number";
    case Kind::String:
      return "a string";
    case Kind::Array:
      return "an array";
    case Kind::Object:
      break;
  }
  return "an object";
}

JsonValue json_tree(const std::filesystem::path& file, std::string_view text) {
  Cursor cursor{text.data(), text.data(), text.data()};
  TreeBuilder builder(file, cursor);
  constexpr bool strict = true, ignore_comments = true;
  json::sax_parse(CountingIterator(text.data(), &cursor),
                  CountingIterator(text.data() + text.size(), &cursor), &builder, json::input_format_t::json,
                  strict, ignore_comments);
  return builder.take_root();
}

}  // namespace luxel
