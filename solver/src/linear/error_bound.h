#pragma once

#include <vector>

#include "linear/system.h"

namespace luxel {

/// A rigorous bound of |B - B*| from the residual r of B.
///
/// I - K has no positive entry off its diagonal. If some v > 0 has w = (I - K) v > 0, it is a nonsingular
/// M-matrix, its inverse is not negative, and |B - B*| <= v max_i |r_i| / w_i (Varga, Matrix Iterative
/// Analysis, ch. 3; Berman and Plemmons 1994, ch. 6). v = 1 has w_i = 1 - rho_i s_i and gives ||r||_inf / (1
/// - max rho_i s_i) or better for nothing. Where most of the scene absorbs, a v with w near 1, found by
/// sharpen(), bounds by the true ||(I - K)^-1||_inf; and it proves a bound where some rho_i s_i reaches 1.
///
/// Rounding of F v, s and r is part of the bound: sums of N numbers are wrong by at most lambda sqrt(N) u
/// times the sum of their sizes, but for a probability below 2 exp(-lambda^2 / 2) (Higham and Mary 2019).
class ErrorBound {
 public:
  explicit ErrorBound(const RadiositySystem& system);

  /// Looks for a better test vector v with a few iterations on (I - K) v = 1; keeps the old one of a channel
  /// where that does not succeed.
  void sharpen();
  /// Whether sharpen() can gain much: no bound yet, or the smallest loss is far below the mean one.
  bool worth_sharpening() const;
  /// Whether there is a bound in every channel.
  bool exists() const;

  /// Upper bound of max_i |B_i - B*_i| / max_i |B*_i|, worst channel; infinity where there is none. 0 where
  /// both residual and emission are 0.
  double relative(const PatchField& residual, const PatchField& radiosity) const;

 private:
  double channel(const PatchField& residual, const PatchField& radiosity, Eigen::Index c) const;

  const RadiositySystem* system_;
  double rounding_;                  ///< relative, of a row's sum
  std::vector<Eigen::Index> first_;  ///< a column of each group of equal reflectance, which share the rest
  std::vector<Eigen::Index> group_;  ///< of each column
  PatchField loss_;                  ///< w, N x groups: a lower bound of (I - K) v
  Eigen::RowVectorXd largest_test_;  ///< max_i v_i of each group
};

}  // namespace luxel
