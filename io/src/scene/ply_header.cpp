#include "scene/ply_header.h"

#include <array>
#include <limits>
#include <utility>

#include "scene/input_location.h"
#include "scene/text_lines.h"

namespace luxel {
namespace {

constexpr std::array number_names{
    std::pair{"char", PlyNumber::Int8},      std::pair{"int8", PlyNumber::Int8},
    std::pair{"uchar", PlyNumber::Uint8},    std::pair{"uint8", PlyNumber::Uint8},
    std::pair{"short", PlyNumber::Int16},    std::pair{"int16", PlyNumber::Int16},
    std::pair{"ushort", PlyNumber::Uint16},  std::pair{"uint16", PlyNumber::Uint16},
    std::pair{"int", PlyNumber::Int32},      std::pair{"int32", PlyNumber::Int32},
    std::pair{"uint", PlyNumber::Uint32},    std::pair{"uint32", PlyNumber::Uint32},
    std::pair{"float", PlyNumber::Float32},  std::pair{"float32", PlyNumber::Float32},
    std::pair{"double", PlyNumber::Float64}, std::pair{"float64", PlyNumber::Float64},
};

class HeaderReader {
 public:
  HeaderReader(const std::filesystem::path& file, std::string_view bytes) : file_(file), rest_(bytes) {}

  PlyHeader read() {
    if (next_line() != "ply") fail("expected \"ply\"");
    while (true) {
      LineWords words(next_line());
      const std::string_view word = words.next();
      if (word == "end_header") break;
      if (word == "format") {
        read_format(words.next());
      } else if (word == "element") {
        read_element(words);
      } else if (word == "property") {
        read_property(words);
      } else if (word != "comment" && word != "obj_info" && !word.empty()) {
        fail("found " + in_quotes(word) + "; expected format, element, property, comment or end_header");
      }
    }
    if (!has_format_) fail("the header states no format");
    for (const PlyElement& element : header_.elements) {
      if (element.properties.empty()) fail("element " + in_quotes(element.name) + " without properties");
    }
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { refuse({file_, header_.lines}, message); }

  std::string_view next_line() {
    const std::size_t end = rest_.find('\n');
    ++header_.lines;
    if (end == std::string_view::npos) fail("the file ends within the header; expected end_header");
    std::string_view line = rest_.substr(0, end);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    rest_.remove_prefix(end + 1);
    header_.bytes += end + 1;
    return line;
  }

  void read_format(std::string_view word) {
    has_format_ = true;
    if (word == "ascii") {
      header_.format = PlyHeader::Format::Text;
    } else if (word == "binary_little_endian") {
      header_.format = PlyHeader::Format::LittleEndian;
    } else if (word == "binary_big_endian") {
      header_.format = PlyHeader::Format::BigEndian;
    } else {
      fail("format " + in_quotes(word) + "; expected ascii, binary_little_endian or binary_big_endian");
    }
  }

  void read_element(LineWords& words) {
    const std::string_view name = words.next();
    const std::string_view count = words.next();
    const std::optional<long long> number = whole_number(count);
    if (!number || *number < 0 || *number > std::numeric_limits<int>::max()) {
      fail("element " + in_quotes(name) + " with count " + in_quotes(count) + "; expected a whole number");
    }
    header_.elements.push_back({std::string(name), static_cast<std::size_t>(*number), {}});
  }

  void read_property(LineWords& words) {
    if (header_.elements.empty()) fail("property before the first element");
    PlyProperty property;
    std::string_view type = words.next();
    if (type == "list") {
      property.list_count = number_type(words.next());
      type = words.next();
    }
    property.type = number_type(type);
    property.name = std::string(words.next());
    header_.elements.back().properties.push_back(std::move(property));
  }

  PlyNumber number_type(std::string_view word) const {
    for (const auto& [name, type] : number_names) {
      if (word == name) return type;
    }
    fail("type " + in_quotes(word) + "; expected char, uchar, short, ushort, int, uint, float or double");
  }

  std::filesystem::path file_;
  std::string_view rest_;
  PlyHeader header_;
  bool has_format_ = false;
};

}  // namespace

int PlyElement::property(std::string_view property_name) const {
  for (std::size_t p = 0; p < properties.size(); ++p) {
    if (properties[p].name == property_name) return static_cast<int>(p);
  }
  return -1;
}

PlyHeader read_ply_header(const std::filesystem::path& file, std::string_view bytes) {
  return HeaderReader(file, bytes).read();
}

}  // namespace luxel
