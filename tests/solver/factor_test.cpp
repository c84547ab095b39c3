#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "linear/factor/cholesky_factor.h"
#include "linear/factor/lu_factor.h"

namespace luxel {
namespace {

Eigen::MatrixXd random_matrix(int rows, int columns, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Eigen::MatrixXd matrix(rows, columns);
  for (double& entry : matrix.reshaped()) entry = uniform(random);
  return matrix;
}

// Sizes about the widths of panels (128, 256) and tiles (512), and none of their multiples.
constexpr int sizes[] = {1, 2, 127, 128, 129, 255, 256, 257, 512, 513, 769, 1100};

template <class Real>
double cholesky_error(int n) {
  const Eigen::MatrixXd half = random_matrix(n, n, n);
  const Eigen::MatrixXd m = Eigen::MatrixXd::Identity(n, n) + half * half.transpose() / n;
  CholeskyFactor<Real> factor(n, [&](int i, Real* row) {
    for (int j = 0; j <= i; ++j) row[j] = static_cast<Real>(m(i, j));
  });
  const Eigen::MatrixXd expected = random_matrix(n, 3, n + 1);
  typename CholeskyFactor<Real>::Block x = (m * expected).template cast<Real>();
  EXPECT_TRUE(factor.factor());
  factor.solve(x);
  return (x.template cast<double>() - expected).cwiseAbs().maxCoeff();
}

template <class Real>
double lu_error(int n) {
  // no diagonal to speak of, so that the pivots matter
  const Eigen::MatrixXd m = random_matrix(n, n, n) + 2 * Eigen::MatrixXd::Identity(n, n).rowwise().reverse();
  LuFactor<Real> factor(n);
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) factor.column(j)[i] = static_cast<Real>(m(i, j));
  }
  const Eigen::MatrixXd expected = random_matrix(n, 3, n + 1);
  typename LuFactor<Real>::Block x = (m * expected).template cast<Real>();
  EXPECT_TRUE(factor.factor());
  factor.solve(x);
  // relative to the condition number, which a random matrix has no bound of
  return (x.template cast<double>() - expected).cwiseAbs().maxCoeff() *
         Eigen::PartialPivLU<Eigen::MatrixXd>(m).rcond();
}

TEST(CholeskyFactor, SolvesForEveryShapeOfPanels) {
  // condition number below 10; rounding u sqrt(n) with room
  for (const int n : sizes) {
    EXPECT_LT(cholesky_error<double>(n), 1e-13) << n;
    EXPECT_LT(cholesky_error<float>(n), 1e-4) << n;
  }
}

TEST(CholeskyFactor, RefusesWhatIsNotPositiveDefinite) {
  for (const int n : {1, 300, 700}) {
    CholeskyFactor<double> factor(n, [&](int i, double* row) {
      std::fill_n(row, i, 0.0);
      row[i] = i == n - 1 ? -1 : 1;
    });

    EXPECT_FALSE(factor.factor()) << n;
  }
}

TEST(LuFactor, SolvesForEveryShapeOfPanels) {
  for (const int n : sizes) {
    EXPECT_LT(lu_error<double>(n), 1e-14) << n;
    EXPECT_LT(lu_error<float>(n), 1e-5) << n;
  }
}

TEST(LuFactor, RefusesASingularMatrix) {
  LuFactor<double> factor(200);
  for (int j = 0; j < 200; ++j) std::fill_n(factor.column(j), 200, 0.0);

  EXPECT_FALSE(factor.factor());
}

}  // namespace
}  // namespace luxel
