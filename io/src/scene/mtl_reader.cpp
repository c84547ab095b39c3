#include "scene/mtl_reader.h"

#include <algorithm>
#include <numbers>
#include <string>

#include "scene/file_text.h"
#include "scene/input_location.h"
#include "scene/text_lines.h"
#include "scene/unused_statements.h"

namespace luxel {
namespace {

class MtlReader {
 public:
  MtlReader(const std::filesystem::path& file, EmissionUnit unit, SurfaceSoup& soup)
      : file_(file), unit_(unit), soup_(soup) {}

  void read() {
    const std::string text = file_text(file_);
    TextLines lines(text);
    while (lines.next()) {
      line_ = lines.number();
      read_statement(lines.line());
    }
    unused_.warn(file_, soup_.warnings);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    refuse({file_, line_}, (has_material_ ? "material " + in_quotes(material_.name) + ": " : "") + message);
  }

  void read_statement(std::string_view line) {
    LineWords words(line);
    const std::string_view statement = words.next();
    if (statement.empty()) return;
    if (statement == "newmtl") {
      begin_material(words.rest());
      return;
    }
    if (!has_material_) fail(in_quotes(statement) + " before the first newmtl");
    if (statement == "Kd") {
      material_.reflectance = reflectance(words.rest());
    } else if (statement == "Ke") {
      material_.emission = emission(words.rest());
    } else if (!has_no_effect(statement, words)) {
      unused_.count(statement);
    }
    if (!is_duplicate_) soup_.stated.back() = material_;
  }

  void begin_material(std::string_view name) {
    has_material_ = false;
    if (name.empty()) fail("newmtl without a name");
    has_material_ = true;
    material_ = {};
    material_.name = std::string(name);
    is_duplicate_ = std::any_of(soup_.stated.begin(), soup_.stated.end(),
                                [&](const StatedFinish& other) { return other.name == name; });
    if (is_duplicate_) {
      soup_.warnings.push_back(file_.string() + ":" + std::to_string(line_) + ": material " +
                               in_quotes(name) + " is defined a second time; the first one counts");
    } else {
      soup_.stated.push_back(material_);
    }
  }

  // "r g b", or "r" for a grey; the MTL format takes r for absent g and b.
  Rgb colour(std::string_view statement, std::string_view text) const {
    Rgb value;
    int count = 0;
    LineWords words(text);
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      const std::optional<double> number = finite_number(word);
      if (!number || count == 3) {
        fail(std::string(statement) + " " + in_quotes(text) + "; expected three finite numbers r g b");
      }
      value[count++] = *number;
    }
    if (count == 1) return Rgb::Constant(value[0]);
    if (count != 3)
      fail(std::string(statement) + " " + in_quotes(text) + "; expected three finite numbers r g b");
    return value;
  }

  Rgb reflectance(std::string_view text) const {
    const Rgb value = colour("Kd", text);
    if ((value < 0).any() || (value > 1).any())
      fail("reflectance Kd " + std::string(text) + "; expected 0 to 1");
    return value;
  }

  Rgb emission(std::string_view text) const {
    const Rgb value = colour("Ke", text);
    if ((value < 0).any() || (value > largest_emission).any()) {
      fail("emission Ke " + std::string(text) + "; expected 0 to 1e100");
    }
    return unit_ == EmissionUnit::Radiance ? Rgb(std::numbers::pi * value) : value;
  }

  // Black speculars and full opacity say what Luxel assumes anyway.
  static bool has_no_effect(std::string_view statement, LineWords words) {
    const bool is_black = statement == "Ks" || statement == "Tr";
    if (!is_black && statement != "d") return false;
    const double neutral = is_black ? 0 : 1;
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      if (finite_number(word) != neutral) return false;
    }
    return true;
  }

  std::filesystem::path file_;
  EmissionUnit unit_;
  SurfaceSoup& soup_;
  StatedFinish material_;
  UnusedStatements unused_;
  bool has_material_ = false;
  bool is_duplicate_ = false;
  int line_ = 0;
};

}  // namespace

void read_mtl(const std::filesystem::path& file, EmissionUnit emission_unit, SurfaceSoup& soup) {
  MtlReader(file, emission_unit, soup).read();
}

int stated_finish(SurfaceSoup& soup, std::string_view name) {
  const auto found = std::find_if(soup.stated.begin(), soup.stated.end(),
                                  [&](const StatedFinish& finish) { return finish.name == name; });
  if (found != soup.stated.end()) return static_cast<int>(found - soup.stated.begin());
  soup.stated.push_back({});
  soup.stated.back().name = std::string(name);
  return static_cast<int>(soup.stated.size()) - 1;
}

}  // namespace luxel
