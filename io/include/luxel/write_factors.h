#pragma once

#include <filesystem>

#include "luxel/dense_operator.h"
#include "luxel/progress.h"

namespace luxel {

/// How form factors are written.
struct FactorFileOptions {
  bool full_precision =
      false;  ///< text: 17 significant digits, which read back to the same bits, instead of 9
};

/// Writes every form factor F_ij that is not 0, row by row, as the extension says:
///   .mtx  MatrixMarket, `coordinate real general`, indices from 1
///   .csv  header i,j,F, indices from 0
///   .h5   HDF5, compressed rows as scipy reads them: data (F, float64), indices (int32), indptr (int64),
///         shape; and areas [m2]
/// The diagonal of flat patches holds only the rounding of the stored entries (below 1e-7): rows then sum to
/// what the operator's rows do. The file appears whole or not at all; memory holds a band of rows at a time.
/// @throws InputError for another extension, or if the file cannot be written; Cancelled
void write_factors(const std::filesystem::path& path, const DenseOperator& transport,
                   const FactorFileOptions& options = {}, const Progress& progress = {});

}  // namespace luxel
