#include "scene/off_reader.h"

#include <limits>

#include "scene/file_text.h"
#include "scene/flat_soup.h"
#include "scene/input_location.h"
#include "scene/text_lines.h"
#include "scene/unused_statements.h"

namespace luxel {
namespace {

class OffReader {
 public:
  explicit OffReader(const std::filesystem::path& file)
      : file_(file), text_(file_text(file)), lines_(text_) {}

  SurfaceSoup read() {
    read_head();
    for (long long v = 0; v < vertex_count_; ++v) read_vertex();
    for (long long f = 0; f < face_count_; ++f) read_face();
    if (soup_.face_count() == 0) refuse({file_}, "has no faces");
    unused_.warn(file_, soup_.warnings());
    return soup_.take();
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { refuse({file_, lines_.number()}, message); }

  // The words of the next line that has any.
  LineWords next_line(std::string_view expected) {
    while (lines_.next()) {
      LineWords words(lines_.line());
      if (!LineWords(words).next().empty()) return words;
    }
    fail("the file ends; expected " + std::string(expected));
  }

  void read_head() {
    LineWords words = next_line("OFF");
    const std::string_view keyword = words.next();
    if (keyword != "OFF" && keyword != "COFF" && keyword != "NOFF" && keyword != "CNOFF") {
      fail("found " + in_quotes(keyword) + "; expected OFF, COFF, NOFF or CNOFF");
    }
    std::string_view first = words.next();
    if (first == "BINARY") fail("binary OFF is not read; expected text");
    if (first.empty()) {
      words = next_line("the numbers of vertices, faces and edges");
      first = words.next();
    }
    vertex_count_ = count(first, "vertices");
    face_count_ = count(words.next(), "faces");
  }

  long long count(std::string_view word, std::string_view what) const {
    const std::optional<long long> number = whole_number(word);
    if (!number || *number < 0 || *number > std::numeric_limits<int>::max()) {
      fail("found " + in_quotes(word) + "; expected the number of " + std::string(what));
    }
    return *number;
  }

  double number(std::string_view word, std::string_view what) const {
    const std::optional<double> value = finite_number(word);
    if (!value) fail(std::string(what) + " " + in_quotes(word) + "; expected a finite number");
    return *value;
  }

  void read_vertex() {
    LineWords words = next_line("a vertex");
    Vec3 vertex;
    for (int i = 0; i < 3; ++i) vertex[i] = number(words.next(), "vertex coordinate");
    if (!words.next().empty()) unused_.count("colour or normal of vertex");
    soup_.vertices().push_back(vertex);
  }

  void read_face() {
    LineWords words = next_line("a face");
    const std::optional<long long> corner_count = whole_number(words.next());
    if (!corner_count || *corner_count < 3) fail("face without a number of corners; expected at least 3");
    corners_.clear();
    for (long long c = 0; c < *corner_count; ++c) {
      const std::string_view word = words.next();
      const std::optional<long long> index = whole_number(word);
      if (!index || *index < 0 || *index >= vertex_count_) {
        fail("face corner " + in_quotes(word) + "; expected a vertex from 0 to " +
             std::to_string(vertex_count_ - 1));
      }
      corners_.push_back(static_cast<int>(*index));
    }
    soup_.add_face(corners_, read_colour(words));
  }

  // Nothing, the index of a colour in a map, r g b or r g b a; whole numbers are of 255.
  std::optional<Rgb> read_colour(LineWords words) {
    std::vector<std::string_view> found;
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) found.push_back(word);
    if (found.empty()) return std::nullopt;
    if (found.size() < 3) {
      unused_.count("colour map of face");
      return std::nullopt;
    }
    Rgb colour;
    bool is_whole = true;
    for (int i = 0; i < 3; ++i) {
      colour[i] = number(found[i], "colour");
      is_whole = is_whole && whole_number(found[i]).has_value();
    }
    if (is_whole && (colour > 1).any()) colour /= 255;
    if ((colour < 0).any() || (colour > 1).any())
      fail("colour of a face beyond its range; expected 0 to 1, or 0 to 255");
    return colour;
  }

  std::filesystem::path file_;
  std::string text_;
  TextLines lines_;
  FlatSoup soup_;
  UnusedStatements unused_;
  std::vector<int> corners_;
  long long vertex_count_ = 0, face_count_ = 0;
};

}  // namespace

SurfaceSoup read_off(const std::filesystem::path& file, const ReadOptions&) {
  return OffReader(file).read();
}

}  // namespace luxel
