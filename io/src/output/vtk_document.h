#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "luxel/vector.h"

namespace luxel {

/// A named array of a VTK file: its own values, or a view of values that outlive the document.
struct VtkArray {
  using Values = std::variant<std::span<const double>, std::span<const int>, std::vector<double>,
                              std::vector<std::uint8_t>, std::vector<std::string>>;
  std::string name;
  Values values;       ///< tuple by tuple
  int components = 1;  ///< 3: colours, named R, G, B, or a place, named X, Y, Z
  std::string unit;    ///< kept with the array; empty: none
  bool place = false;
};

/// What a .vtp or .vtu file holds, with no type of VTK's: handed to the module that writes it.
struct VtkDocument {
  std::span<const Vec3> points;         ///< [m]
  std::vector<long long> offsets;       ///< cells + 1 entries into `connectivity`
  std::vector<long long> connectivity;  ///< points of each cell: 3 or 4
  std::vector<VtkArray> cell_arrays;
  std::vector<VtkArray> point_arrays;
  std::vector<VtkArray> field_arrays;
  std::string active_cell_scalars;   ///< what ParaView colours by on opening
  std::string active_point_scalars;  ///< likewise; empty: none
  bool unstructured = false;         ///< .vtu instead of .vtp
};

/// Writes the document; gives the reason if it could not, else "".
using VtkWriter = std::string (*)(const VtkDocument& document, const std::string& path);

/// The symbol of the module luxel_vtk that holds its VtkWriter; its number changes with VtkDocument.
constexpr const char* vtk_writer_symbol = "luxel_vtk_writer_1";

}  // namespace luxel
