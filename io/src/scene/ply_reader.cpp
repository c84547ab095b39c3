#include "scene/ply_reader.h"

#include <array>
#include <cmath>

#include "scene/file_text.h"
#include "scene/flat_soup.h"
#include "scene/input_location.h"
#include "scene/ply_header.h"
#include "scene/ply_numbers.h"
#include "scene/unused_statements.h"

namespace luxel {
namespace {

// Where the three channels of a quantity stand among an element's properties; equal for a grey, -1 for none.
using Channels = std::array<int, 3>;

bool are_found(const Channels& channels) {
  return channels[0] >= 0 && channels[1] >= 0 && channels[2] >= 0;
}

Channels channels_of(const PlyElement& element, const std::string& name) {
  const int grey = element.property(name);
  if (grey >= 0) return {grey, grey, grey};
  return {element.property(name + "_r"), element.property(name + "_g"), element.property(name + "_b")};
}

class PlyReader {
 public:
  explicit PlyReader(const std::filesystem::path& file)
      : file_(file),
        bytes_(file_bytes(file)),
        header_(read_ply_header(file, bytes_)),
        numbers_(file, bytes_, header_) {}

  SurfaceSoup read() {
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face") {
        read_faces(element);
      } else {
        if (element.count > 0) unused_.count("element " + element.name);
        for (std::size_t i = 0; i < element.count; ++i) read_values(element, -1);
      }
    }
    if (soup_.face_count() == 0) refuse({file_}, "has no faces");
    unused_.warn(file_, soup_.warnings());
    return soup_.take();
  }

 private:
  // The scalar properties of the next element into values_, the list with the given number into list_.
  void read_values(const PlyElement& element, int list) {
    numbers_.begin_element();
    values_.assign(element.properties.size(), 0);
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (!property.list_count) {
        values_[p] = numbers_.next(property.type);
        continue;
      }
      const double length = numbers_.next(*property.list_count);
      if (length < 0 || length != std::floor(length))
        numbers_.fail("list of a length that is no whole number");
      if (static_cast<int>(p) == list) list_.clear();
      for (double i = 0; i < length; ++i) {
        const double number = numbers_.next(property.type);
        if (static_cast<int>(p) == list) list_.push_back(number);
      }
    }
  }

  void read_vertices(const PlyElement& element) {
    const std::array at{element.property("x"), element.property("y"), element.property("z")};
    if (!are_found(at)) refuse({file_}, "vertices without x, y and z");
    count_unused(element, {at[0], at[1], at[2]});
    for (std::size_t v = 0; v < element.count; ++v) {
      read_values(element, -1);
      soup_.vertices().emplace_back(values_[at[0]], values_[at[1]], values_[at[2]]);
    }
    has_vertices_ = true;
  }

  void read_faces(const PlyElement& element) {
    if (!has_vertices_) refuse({file_}, "faces before the vertices");
    int list = element.property("vertex_indices");
    if (list < 0) list = element.property("vertex_index");
    if (list < 0 || !element.properties[list].list_count)
      refuse({file_}, "faces without a list vertex_indices");
    const Channels reflectance = channels_of(element, "reflectance");
    const Channels emission = channels_of(element, "emission");
    std::vector<int> used{list};
    if (are_found(reflectance)) used.insert(used.end(), reflectance.begin(), reflectance.end());
    if (are_found(emission)) used.insert(used.end(), emission.begin(), emission.end());
    count_unused(element, used);
    for (std::size_t f = 0; f < element.count; ++f) {
      read_values(element, list);
      face_name_ = "face " + std::to_string(f) + ": ";
      soup_.add_face(corners(), colour(reflectance, "reflectance", 1, "0 to 1"),
                     colour(emission, "emission", largest_emission, "0 to 1e100"));
    }
  }

  std::vector<int> corners() const {
    if (list_.size() < 3)
      numbers_.fail(face_name_ + counted(list_.size(), "corner") + "; expected at least 3");
    std::vector<int> indices;
    const std::size_t vertices = header_vertices();
    for (const double number : list_) {
      if (!(number >= 0 && number < static_cast<double>(vertices)) || number != std::floor(number)) {
        numbers_.fail(face_name_ + "a corner is no vertex; expected 0 to " + std::to_string(vertices - 1));
      }
      indices.push_back(static_cast<int>(number));
    }
    return indices;
  }

  std::size_t header_vertices() const {
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") return element.count;
    }
    return 0;
  }

  std::optional<Rgb> colour(const Channels& at, std::string_view name, double most,
                            std::string_view range) const {
    if (!are_found(at)) return std::nullopt;
    const Rgb value(values_[at[0]], values_[at[1]], values_[at[2]]);
    if ((value < 0).any() || (value > most).any()) {
      numbers_.fail(face_name_ + std::string(name) + " out of range; expected " + std::string(range));
    }
    return value;
  }

  void count_unused(const PlyElement& element, const std::vector<int>& used) {
    if (element.count == 0) return;
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      bool is_used = false;
      for (const int u : used) is_used = is_used || u == static_cast<int>(p);
      if (!is_used) unused_.count(element.properties[p].name + " of " + element.name);
    }
  }

  std::filesystem::path file_;
  std::string bytes_;
  PlyHeader header_;
  PlyNumbers numbers_;
  FlatSoup soup_;
  UnusedStatements unused_;
  std::vector<double> values_, list_;
  std::string face_name_;
  bool has_vertices_ = false;
};

}  // namespace

SurfaceSoup read_ply(const std::filesystem::path& file, const ReadOptions&) {
  return PlyReader(file).read();
}

}  // namespace luxel
