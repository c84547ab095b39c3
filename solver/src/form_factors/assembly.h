#pragma once

#include "form_factors/cluster_tree.h"
#include "luxel/form_factors.h"

// The passes that form_factors() runs one after the other on one ExchangeMatrix. The matrix is in mesh order
// and in m2 from the first write on: entry (i, j) of patches s and t of the tree is
// (tree.patches[s].patch, tree.patches[t].patch), and a value in working units is divided by scale^2 (see
// metres_squared). No pass permutes anything, so that memory never holds two copies. Passes run their blocks
// on TBB; different blocks write different entries, and each entry depends on its pair alone, so that the
// bits are the same for any number of threads.

namespace luxel {

/// An area in working coordinates in m2: exact, the scale is a power of two.
inline double metres_squared(const ClusterTree& tree, double working_area) {
  return working_area / (tree.scale * tree.scale);
}

/// Pass 1: writes the exchange areas of all pairs that face each other as if nothing hid them; the entries of
/// the others stay 0. Sets pairs, facing_pairs and estimated_error of the report.
/// @param accuracy  A as in FormFactorOptions
/// @throws Cancelled
void fill_unoccluded(const ClusterTree& tree, double accuracy, ExchangeMatrix& exchange_areas,
                     FormFactorReport& report, const Progress& progress);

/// Pass 2: takes away what is hidden, pair by pair or block by block, and sets the report's other numbers.
/// Entries that nothing hides are not touched.
/// @throws Cancelled
void subtract_hidden(const PatchMesh& mesh, const ClusterTree& tree, const FormFactorOptions& options,
                     ExchangeMatrix& exchange_areas, FormFactorReport& report, const Progress& progress);

}  // namespace luxel
