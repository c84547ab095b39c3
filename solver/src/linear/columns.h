#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

#include "luxel/vector.h"

namespace luxel {

/// Rows that one task takes: large enough to hide a task's start (about 1 us), small enough for the cache.
/// The partition does not depend on the number of threads, so that sums over it do not either.
inline constexpr int rows_per_task = 2048;

/// Calls body(first, count) for consecutive blocks of rows, in parallel.
template <class Body>
void for_row_blocks(Eigen::Index rows, const Body& body) {
  const Eigen::Index blocks = (rows + rows_per_task - 1) / rows_per_task;
  const auto run = [&](Eigen::Index block) {
    const Eigen::Index first = block * rows_per_task;
    body(first, std::min<Eigen::Index>(rows_per_task, rows - first));
  };
  if (blocks == 1) return run(0);
  tbb::parallel_for(Eigen::Index(0), blocks, run);
}

/// Adds up what term(first, count) gives for each block of rows, a row of `columns` numbers, in row order.
template <class Term>
Eigen::RowVectorXd sum_over_rows(Eigen::Index rows, Eigen::Index columns, const Term& term) {
  const Eigen::Index blocks = (rows + rows_per_task - 1) / rows_per_task;
  std::vector<Eigen::RowVectorXd> partial(blocks);
  for_row_blocks(rows, [&](Eigen::Index first, Eigen::Index count) {
    partial[first / rows_per_task] = term(first, count);
  });
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(columns);
  for (const auto& part : partial) sum += part;
  return sum;
}

/// sum_i w_i x_i y_i of each column. `weights` is N x m, or N x 1 for the same weight in all columns.
template <class Weights>
Eigen::RowVectorXd weighted_dots(const Weights& weights, const PatchField& x, const PatchField& y) {
  const bool shared = weights.cols() == 1;
  return sum_over_rows(x.rows(), x.cols(), [&](Eigen::Index first, Eigen::Index count) {
    Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(x.cols());
    for (Eigen::Index i = first; i < first + count; ++i) {
      for (Eigen::Index c = 0; c < x.cols(); ++c) {
        sum[c] += weights(i, shared ? 0 : c) * x(i, c) * y(i, c);
      }
    }
    return sum;
  });
}

}  // namespace luxel
