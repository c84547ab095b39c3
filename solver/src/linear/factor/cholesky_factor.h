#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

namespace luxel {

/// L of a symmetric positive definite matrix M = L L^T, in panels of columns: panel k holds the rows from its
/// own first column on, row-major and contiguous, so that every tile of it is one block of memory. Memory:
/// n^2 / 2 numbers plus n panel_width / 2, factored in place. The same bits for any number of threads.
template <class Real>
class CholeskyFactor {
 public:
  using Block = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// @param fill_row  writes row i of M, columns 0 to i; called once for each row, from many threads
  CholeskyFactor(int size, const std::function<void(int i, Real* row)>& fill_row);

  /// False where M is not positive definite. Cost: n^3 / 3 operations.
  bool factor();

  /// X <- M^-1 X, n x m. Cost: two passes over L.
  void solve(Block& x) const;

 private:
  int panel_count() const { return static_cast<int>(panels_.size()); }
  int first(int panel) const;
  int width(int panel) const { return first(panel + 1) - first(panel); }
  /// Row i of panel k.
  Real* row(int panel, int i) const;

  int size_;
  std::vector<std::unique_ptr<Real[]>> panels_;
};

extern template class CholeskyFactor<float>;
extern template class CholeskyFactor<double>;

}  // namespace luxel
