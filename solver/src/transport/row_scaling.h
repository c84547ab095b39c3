#pragma once

#include <functional>
#include <span>
#include <vector>

#include "luxel/progress.h"

namespace luxel {

/// Factors d_i with which the rows of d_i d_j G_ij sum to the areas.
struct RowScaling {
  std::vector<double> factors;  ///< N; 1 where rows were not asked for
  std::vector<double> errors;   ///< N: |row sum / area - 1| that is left; 0 where rows were not asked for
  int iterations = 0;           ///< Newton steps
  bool converged = false;       ///< every error is below tolerance
};

/// y = G x for a symmetric G >= 0; x and y are N numbers.
using SymmetricProduct = std::function<void(const double* x, double* y)>;

/// Scales the rows i with active[i] != 0 by the minimum over u = log d of the convex function
///   1/2 sum_ij d_i d_j G_ij - sum_i A_i u_i,
/// whose gradient is row sums minus areas: damped Newton, each step by conjugate gradients with the row sums
/// as preconditioner. Quadratic at the end; about 20 passes over G from errors of 1e-3 to 1e-13. Where no
/// such factors within [1/4, 4] exist, converged is false. Source: Knight and Ruiz 2013, for the symmetric
/// case.
/// @param tolerance  relative row error to stop at, >= 1e-13
RowScaling scale_rows(const SymmetricProduct& product, std::span<const double> areas,
                      std::span<const char> active, double tolerance, const Progress& progress);

/// Factors for all enclosures that can be closed.
struct RowClosure {
  std::vector<double> factors;  ///< N; 1 where nothing is scaled
  std::vector<char> closed;     ///< N: rows that sum to the areas now
  int iterations = 0;           ///< Newton steps
  int unclosed = -1;            ///< a row of an enclosure that could not be closed; -1: none such
};

/// scale_rows() on the active rows; enclosures whose rows keep an error above `within` are given up and the
/// others scaled without them.
/// @param enclosure  N: of each row
RowClosure close_enclosures(const SymmetricProduct& product, std::span<const double> areas,
                            std::span<const int> enclosure, std::vector<char> active, double within,
                            const Progress& progress);

}  // namespace luxel
