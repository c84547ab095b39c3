#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

namespace luxel {

/// Consecutive rows of a sparse matrix: their column indices and values, one row after the other.
struct CsrPiece {
  std::span<const std::int32_t> indices;
  std::span<const double> data;
};

/// A sparse matrix that comes piece by piece, and what goes with it; no type of HDF5's.
struct CsrDocument {
  std::span<const std::int64_t> indptr;  ///< rows + 1
  std::span<const double> areas;         ///< rows [m2]
  std::int64_t columns = 0;
  /// Hands out every piece in order until the taker returns false; false if it did not come to the end.
  std::function<bool(const std::function<bool(const CsrPiece&)>& take)> pieces;
};

/// Writes the document; gives the reason if it could not, else "". No exception crosses, either way.
using CsrWriter = std::string (*)(const CsrDocument& document, const std::string& path);

/// The symbol of the module luxel_hdf5 that holds its CsrWriter; its number changes with CsrDocument.
constexpr const char* csr_writer_symbol = "luxel_csr_writer_1";

}  // namespace luxel
