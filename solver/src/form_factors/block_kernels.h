#pragma once

#include "form_factors/patch_points.h"

namespace luxel {

/// Rows [i0, i1) times columns [j0, j1) of exchange areas in working units, row-major in a buffer whose rows
/// are `tile_columns` long.
struct Tile {
  static constexpr int rows = 64, columns = 64;
  alignas(64) double values[rows * columns];
};

/// Exchange areas of all pairs of two ranges of at most 64 patches, all wholly in front of each other, by
/// point pairs. Relative rounding 1e-8 with `fine` false, 1e-14 with `fine` true.
void fill_tile(const PatchPoints& points, const PatchPlanes& planes, int i0, int i1, int j0, int j1,
               bool fine, Tile& tile);

}  // namespace luxel
