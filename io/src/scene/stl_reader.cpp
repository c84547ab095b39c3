#include "scene/stl_reader.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/binary_numbers.h"
#include "scene/file_text.h"
#include "scene/flat_soup.h"
#include "scene/input_location.h"
#include "scene/text_lines.h"

namespace luxel {
namespace {

// A binary file: 80 bytes of comment, the number of triangles, and for each a normal, three corners and two
// bytes.
constexpr std::size_t count_offset = 80, head_bytes = 84, triangle_bytes = 50, normal_bytes = 12;

std::size_t stated_triangles(std::string_view bytes) {
  return bytes.size() < head_bytes ? 0 : number_at<std::uint32_t>(bytes, count_offset, std::endian::little);
}

// Binary files may begin with "solid" too; their length tells.
bool is_binary(std::string_view bytes) {
  if (bytes.size() >= head_bytes && bytes.size() == head_bytes + triangle_bytes * stated_triangles(bytes))
    return true;
  return !bytes.starts_with("solid");
}

void add_triangle(FlatSoup& soup, const std::array<Vec3, 3>& corners) {
  const auto first = static_cast<int>(soup.vertices().size());
  soup.vertices().insert(soup.vertices().end(), corners.begin(), corners.end());
  soup.add_face(std::array{first, first + 1, first + 2});
}

SurfaceSoup read_binary(const std::filesystem::path& file, std::string_view bytes) {
  const std::size_t count = stated_triangles(bytes);
  if (bytes.size() < head_bytes || bytes.size() < head_bytes + triangle_bytes * count) {
    refuse({file},
           "is cut off, or no STL: " + counted(bytes.size(), "byte") + " for " + counted(count, "triangle"));
  }
  FlatSoup soup;
  for (std::size_t t = 0; t < count; ++t) {
    std::array<Vec3, 3> corners;
    for (std::size_t i = 0; i < 9; ++i) {
      const std::size_t at = head_bytes + triangle_bytes * t + normal_bytes + 4 * i;
      const double number = number_at<float>(bytes, at, std::endian::little);
      if (!std::isfinite(number))
        refuse({file}, "triangle " + std::to_string(t) + ": a coordinate is not finite");
      corners[i / 3][static_cast<int>(i % 3)] = number;
    }
    add_triangle(soup, corners);
  }
  if (count == 0) refuse({file}, "has no faces");
  return soup.take();
}

SurfaceSoup read_text(const std::filesystem::path& file) {
  const std::string text = file_text(file);
  TextLines lines(text);
  FlatSoup soup;
  std::array<Vec3, 3> corners;
  std::size_t count = 0;
  const auto fail = [&](const std::string& message) { refuse({file, lines.number()}, message); };
  while (lines.next()) {
    LineWords words(lines.line());
    const std::string_view word = words.next();
    if (word == "solid") {
      soup.begin_group(words.rest());
    } else if (word == "vertex") {
      if (count == 3) fail("a fourth vertex; expected triangles");
      for (int i = 0; i < 3; ++i) {
        const std::string_view spelt = words.next();
        const std::optional<double> number = finite_number(spelt);
        if (!number) fail("vertex coordinate " + in_quotes(spelt) + "; expected a finite number");
        corners[count][i] = *number;
      }
      ++count;
    } else if (word == "endloop") {
      if (count != 3) fail("facet with " + counted(count, "corner") + "; expected 3");
      add_triangle(soup, corners);
      count = 0;
    } else if (word != "facet" && word != "outer" && word != "endfacet" && word != "endsolid" &&
               !word.empty()) {
      fail("found " + in_quotes(word) + "; expected facet, outer, vertex, endloop, endfacet or endsolid");
    }
  }
  if (count != 0) fail("the file ends within a facet");
  if (soup.face_count() == 0) refuse({file}, "has no faces");
  return soup.take();
}

}  // namespace

SurfaceSoup read_stl(const std::filesystem::path& file, const ReadOptions&) {
  const std::string bytes = file_bytes(file);
  return is_binary(bytes) ? read_binary(file, bytes) : read_text(file);
}

}  // namespace luxel
