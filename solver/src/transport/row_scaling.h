#pragma once

#include <span>
#include <vector>

#include "luxel/exchange_matrix.h"
#include "luxel/progress.h"

namespace luxel {

/// Factors d_i with which the rows of d_i d_j G_ij sum to the areas.
struct RowScaling {
  std::vector<double> factors;  ///< N; 1 where rows were not asked for
  std::vector<double> errors;   ///< N: |row sum / area - 1| that is left; 0 where rows were not asked for
  int iterations = 0;           ///< Newton steps
  bool converged = false;       ///< every error is below tolerance
};

/// Scales the rows i with active[i] != 0 by the minimum over u = log d of the convex function
///   1/2 sum_ij d_i d_j G_ij - sum_i A_i u_i,
/// whose gradient is row sums minus areas: damped Newton, each step by conjugate gradients with the row sums
/// as preconditioner. Quadratic at the end; about 20 passes over G from errors of 1e-3. Where no such factors
/// within [1/4, 4] exist, converged is false. Source: Knight and Ruiz 2013, for the symmetric case.
RowScaling scale_rows(const ExchangeMatrix& matrix, std::span<const double> areas,
                      std::span<const char> active, const Progress& progress);

}  // namespace luxel
