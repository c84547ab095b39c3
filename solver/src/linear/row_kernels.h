#pragma once

#include <Eigen/Core>

namespace luxel {

// Eight independent sums keep the vector units busy and their order does not depend on the machine.
inline constexpr int row_lanes = 8;

/// sum_j row[j] x[j] over `count` entries as stored, in float64.
template <class Real>
double dot_row(const Real* row, const double* x, int count) {
  double sums[row_lanes] = {};
  int j = 0;
  for (; j + row_lanes <= count; j += row_lanes) {
    for (int lane = 0; lane < row_lanes; ++lane)
      sums[lane] += static_cast<double>(row[j + lane]) * x[j + lane];
  }
  double sum = ((sums[0] + sums[1]) + (sums[2] + sums[3])) + ((sums[4] + sums[5]) + (sums[6] + sums[7]));
  for (; j < count; ++j) sum += static_cast<double>(row[j]) * x[j];
  return sum;
}

/// y[j] += factor row[j] over `count` entries.
template <class Real>
void add_scaled_row(const Real* row, double factor, double* y, int count) {
  for (int j = 0; j < count; ++j) y[j] += factor * static_cast<double>(row[j]);
}

}  // namespace luxel
