#pragma once

#include <vector>

#include "luxel/exchange_matrix.h"

namespace luxel {

/// Y = G X for a half-stored symmetric G with zero diagonal; every entry is read once and used for both of
/// its places. x and y are N x columns, row-major. Products and sums are in float64, in an order that depends
/// on N alone: the same bits for any number of threads. Memory besides: one row of partial sums a block,
/// about N^2 columns / 128 bytes, never over 256 N columns.
void symmetric_product(const ExchangeMatrix& matrix, const double* x, double* y, int columns);

/// The rows [begin, end) of one block of the product; begin is a multiple of 8.
struct RowBlock {
  int begin = 0, end = 0;
};

/// The fixed partition of N rows: blocks of about equal numbers of entries.
std::vector<RowBlock> row_blocks(int size);

}  // namespace luxel
