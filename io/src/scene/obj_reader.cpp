#include "scene/obj_reader.h"

#include <array>
#include <charconv>
#include <limits>
#include <utility>

#include "scene/file_text.h"
#include "scene/input_location.h"
#include "scene/mtl_reader.h"
#include "scene/name_table.h"
#include "scene/text_lines.h"
#include "scene/unused_statements.h"

namespace luxel {
namespace {

// A name that the following faces carry; it is numbered when the first face uses it.
struct CurrentName {
  std::string_view name;
  int number = -1;

  int of(NameTable& table, std::string_view otherwise) {
    if (number < 0) number = table.number(name.empty() ? otherwise : name);
    return number;
  }
};

class ObjReader {
 public:
  ObjReader(const std::filesystem::path& file, const ReadOptions& options) : file_(file), options_(options) {}

  SurfaceSoup read() {
    const std::string text = file_text(file_);
    reserve(text.size());
    TextLines lines(text);
    while (lines.next()) {
      line_ = lines.number();
      read_statement(lines.line());
    }
    check_forward_references();
    if (soup_.face_count() == 0) refuse({file_}, "has no faces");
    unused_.warn(file_, soup_.warnings);
    soup_.groups = groups_.names();
    soup_.materials = materials_.names();
    assign_stated_finishes();
    return std::move(soup_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { refuse({file_, line_}, message); }

  void reserve(std::size_t bytes) {
    // Triangle meshes of a typical exporter take 36 bytes a face and have half as many vertices as faces.
    const std::size_t faces = bytes / 36;
    soup_.vertices.reserve(faces / 2);
    soup_.face_offsets.reserve(faces);
    soup_.face_vertices.reserve(3 * faces);
  }

  void read_statement(std::string_view line) {
    LineWords words(line);
    const std::string_view statement = words.next();
    if (statement.empty()) return;
    if (statement == "v") {
      read_vertex(words);
    } else if (statement == "f" || statement == "fo") {
      read_face(words);
    } else if (statement == "g") {
      name_group(words.rest());
    } else if (statement == "o") {
      object_name_ = std::string(words.rest());
      group_.number = -1;
    } else if (statement == "usemtl") {
      material_name_ = std::string(words.rest());
      material_ = {material_name_};
    } else if (statement == "mtllib") {
      read_libraries(words);
    } else {
      unused_.count(statement);
    }
  }

  void name_group(std::string_view name) {
    group_name_ = std::string(name);
    group_ = {group_name_};
  }

  void read_vertex(LineWords& words) {
    // x y z, a weight w, a colour r g b.
    std::array<double, 7> numbers;
    std::size_t count = 0;
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      if (count == numbers.size()) fail("vertex with more than 7 numbers; expected v x y z");
      const std::optional<double> number = finite_number(word);
      if (!number) fail("vertex coordinate " + in_quotes(word) + "; expected a finite number");
      numbers[count++] = *number;
    }
    if (count < 3) fail("vertex with " + counted(count, "number") + "; expected v x y z");
    if (count == 4 || count == 7) unused_.count("weight of v");
    if (count >= 6) unused_.count("colour of v");
    soup_.vertices.emplace_back(numbers[0], numbers[1], numbers[2]);
  }

  void read_face(LineWords& words) {
    const std::size_t first = soup_.face_vertices.size();
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      soup_.face_vertices.push_back(corner(word));
    }
    const std::size_t count = soup_.face_vertices.size() - first;
    if (count < 3) fail("face with " + counted(count, "corner") + "; expected at least 3");
    if (soup_.face_vertices.size() > std::numeric_limits<int>::max()) fail("more than 2^31 face corners");
    soup_.face_offsets.push_back(static_cast<int>(soup_.face_vertices.size()));
    soup_.face_groups.push_back(group_.of(groups_, object_name_.empty() ? default_name : object_name_));
    soup_.face_materials.push_back(material_.of(materials_, default_name));
  }

  // The vertex of a corner "v", "v/vt", "v//vn" or "v/vt/vn"; texture and normal must be spelt right, no
  // more.
  int corner(std::string_view word) {
    long long index = 0;
    const char* end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, index);
    if (error == std::errc::invalid_argument || (stop != end && *stop != '/')) {
      fail("face corner " + in_quotes(word) + "; expected a vertex number");
    }
    const std::string_view others(stop, static_cast<std::size_t>(end - stop));
    if (others.find_first_not_of("/-0123456789") != std::string_view::npos) {
      fail("face corner " + in_quotes(word) + "; expected v, v/vt, v//vn or v/vt/vn");
    }
    return vertex_of(index, word, error == std::errc::result_out_of_range);
  }

  int vertex_of(long long index, std::string_view word, bool overflow) {
    const auto known = static_cast<long long>(soup_.vertices.size());
    if (!overflow && index > 0 && index <= known) return static_cast<int>(index - 1);
    if (!overflow && index < 0 && -index <= known) return static_cast<int>(known + index);
    if (!overflow && index == 0) fail("face corner " + in_quotes(word) + "; vertices count from 1");
    if (overflow || index < 0 || index > std::numeric_limits<int>::max()) {
      fail("face corner " + in_quotes(word) + "; so far there are " + std::to_string(known) + " vertices");
    }
    forward_references_.push_back({static_cast<int>(index), line_});
    return static_cast<int>(index - 1);
  }

  // A face may come before its vertices, as long as they do come.
  void check_forward_references() {
    for (const auto& [index, line] : forward_references_) {
      if (static_cast<std::size_t>(index) > soup_.vertices.size()) {
        line_ = line;
        fail("face corner " + in_quotes(std::to_string(index)) + "; the file has " +
             std::to_string(soup_.vertices.size()) + " vertices");
      }
    }
  }

  // File names may hold blanks, and one statement may name several files.
  void read_libraries(LineWords& words) {
    const std::string_view whole = words.rest();
    if (whole.empty()) fail("mtllib without a file name");
    if (std::filesystem::exists(library_path(whole))) {
      read_library(whole);
      return;
    }
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) read_library(word);
  }

  std::filesystem::path library_path(std::string_view name) const {
    return file_.parent_path() / std::filesystem::path(name);
  }

  void read_library(std::string_view name) {
    const std::filesystem::path library = library_path(name);
    if (!std::filesystem::exists(library)) {
      soup_.warnings.push_back(file_.string() + ":" + std::to_string(line_) + ": material library " +
                               in_quotes(name) + " does not exist");
      return;
    }
    read_mtl(library, options_.emission_unit, soup_);
  }

  // Stated finishes in the order of the libraries, then empty ones for the names that no library defines.
  void assign_stated_finishes() {
    std::vector<int> stated_of_material;
    for (const std::string& name : soup_.materials) stated_of_material.push_back(stated_finish(soup_, name));
    soup_.face_stated.reserve(soup_.face_count());
    for (const int material : soup_.face_materials) soup_.face_stated.push_back(stated_of_material[material]);
  }

  std::filesystem::path file_;
  ReadOptions options_;
  SurfaceSoup soup_;
  NameTable groups_, materials_;
  std::string group_name_, object_name_, material_name_;
  CurrentName group_, material_;
  UnusedStatements unused_;
  std::vector<std::pair<int, int>> forward_references_;  // vertex number, line
  int line_ = 0;
};

}  // namespace

SurfaceSoup read_obj(const std::filesystem::path& file, const ReadOptions& options) {
  return ObjReader(file, options).read();
}

}  // namespace luxel
