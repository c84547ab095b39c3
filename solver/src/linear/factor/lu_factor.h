#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace luxel {

/// P L U of a square matrix M, with partial pivoting, in panels of columns, each column-major and contiguous.
/// Memory: n^2 numbers, factored in place. The same bits for any number of threads.
template <class Real>
class LuFactor {
 public:
  using Block = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

  /// Entries are not set.
  explicit LuFactor(int size);

  int size() const { return size_; }
  /// Column j of M, to be filled before factor().
  Real* column(int j);

  /// False where M is singular. Cost: 2 n^3 / 3 operations.
  bool factor();

  /// X <- M^-1 X, n x m. Cost: one pass over L and U.
  void solve(Block& x) const;

 private:
  int panel_count() const { return static_cast<int>(panels_.size()); }
  int first(int panel) const;
  int width(int panel) const { return first(panel + 1) - first(panel); }
  /// Row i of panel k's first column.
  Real* at(int panel, int i) const { return panels_[panel].get() + i; }

  int size_;
  std::vector<std::unique_ptr<Real[]>> panels_;
  std::vector<int> pivots_;  ///< of each panel, counted from its own first row and 1, as LAPACK gives them
};

extern template class LuFactor<float>;
extern template class LuFactor<double>;

}  // namespace luxel
