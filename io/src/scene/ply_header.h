#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace luxel {

enum class PlyNumber { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

struct PlyProperty {
  std::string name;
  PlyNumber type = PlyNumber::Float32;
  std::optional<PlyNumber> list_count;  ///< type of the length where the property is a list
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;

  /// The number of the property with this name, or -1.
  int property(std::string_view property_name) const;
};

struct PlyHeader {
  enum class Format { Text, LittleEndian, BigEndian };
  Format format = Format::Text;
  std::vector<PlyElement> elements;
  std::size_t bytes = 0;  ///< where the data begin
  int lines = 0;          ///< how many lines the header has
};

/// The header of a PLY file. @throws InputError with the line that cannot be read.
PlyHeader read_ply_header(const std::filesystem::path& file, std::string_view bytes);

}  // namespace luxel
