#pragma once

#include <Eigen/Core>
#include <optional>
#include <random>
#include <vector>

#include "luxel/exchange_matrix.h"
#include "luxel/transport_operator.h"

namespace luxel::test {

/// F given as a matrix. From exchange areas it is symmetric and has entries; from rows it is neither.
class MatrixOperator : public TransportOperator {
 public:
  /// A_i F_ij, symmetric; the diagonal is kept in float64.
  static MatrixOperator from_exchange_areas(const Eigen::MatrixXd& exchange, const Eigen::VectorXd& areas,
                                            Precision precision = Precision::float64) {
    ExchangeMatrix entries(static_cast<int>(areas.size()), precision);
    for (int i = 0; i < areas.size(); ++i) {
      for (int j = 0; j < i; ++j) entries.set(i, j, exchange(i, j));
    }
    Eigen::MatrixXd rows(areas.size(), areas.size());
    for (int i = 0; i < areas.size(); ++i) {
      for (int j = 0; j < areas.size(); ++j)
        rows(i, j) = (i == j ? exchange(i, i) : entries(i, j)) / areas[i];
    }
    MatrixOperator result(rows, areas);
    result.entries_ = std::move(entries);
    result.diagonal_.resize(areas.size());
    for (int i = 0; i < areas.size(); ++i) result.diagonal_[i] = exchange(i, i);
    return result;
  }

  /// F itself, not symmetric, without entries.
  MatrixOperator(Eigen::MatrixXd rows, const Eigen::VectorXd& areas)
      : rows_(std::move(rows)), areas_(areas.begin(), areas.end()) {
    const Eigen::VectorXd sums = rows_.rowwise().sum();
    row_sums_.assign(sums.begin(), sums.end());
  }

  int size() const override { return static_cast<int>(areas_.size()); }
  void apply(const double* x, double* y, int columns) const override {
    using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<Block>(y, size(), columns).noalias() = rows_ * Eigen::Map<const Block>(x, size(), columns);
  }
  std::span<const double> row_sums() const override { return row_sums_; }
  std::span<const double> areas() const override { return areas_; }
  bool symmetric() const override { return entries_.has_value(); }
  std::size_t bytes() const override { return rows_.size() * sizeof(double); }
  std::string_view kind() const override { return "matrix"; }
  const ExchangeMatrix* entries() const override { return entries_ ? &*entries_ : nullptr; }
  std::span<const double> diagonal() const override { return diagonal_; }

  const Eigen::MatrixXd& rows() const { return rows_; }

 private:
  Eigen::MatrixXd rows_;
  std::vector<double> areas_;
  std::vector<double> row_sums_;
  std::optional<ExchangeMatrix> entries_;
  std::vector<double> diagonal_;
};

/// A cube of six patches with side 1, in the order floor, ceiling, four walls. Source of the two factors:
/// Howell's catalogue C-11 and C-14.
inline MatrixOperator cube6() {
  constexpr double opposite = 0.199824895698387, adjacent = 0.200043776075403;
  Eigen::MatrixXd f = Eigen::MatrixXd::Constant(6, 6, adjacent);
  f.diagonal().setZero();
  for (const auto& [i, j] : {std::pair(0, 1), std::pair(2, 4), std::pair(3, 5)}) f(i, j) = f(j, i) = opposite;
  return MatrixOperator::from_exchange_areas(f, Eigen::VectorXd::Ones(6));
}

/// The inside of a sphere in n patches of these areas: F_ij = A_j / sum A exactly, F_ii too.
inline MatrixOperator sphere(const Eigen::VectorXd& areas, Precision precision = Precision::float64) {
  return MatrixOperator::from_exchange_areas(areas * areas.transpose() / areas.sum(), areas, precision);
}

/// Two facing unit squares at distance 1, open to all sides. Source: Howell's catalogue C-11.
inline MatrixOperator two_plates() {
  constexpr double facing = 0.199824895698387;
  return MatrixOperator::from_exchange_areas((Eigen::MatrixXd(2, 2) << 0, facing, facing, 0).finished(),
                                             Eigen::VectorXd::Ones(2));
}

/// The cube with its floor listed twice, so that rows sum to 1.2 and F has the spectral radius 1.148331.
inline MatrixOperator cube_with_duplicate_floor() {
  const Eigen::MatrixXd f = cube6().rows();
  std::vector<int> order{0, 1, 2, 3, 4, 5, 0};
  Eigen::MatrixXd doubled = f(order, order);
  return MatrixOperator::from_exchange_areas(doubled, Eigen::VectorXd::Ones(7));
}

/// Two operators side by side, which do not see each other.
inline MatrixOperator side_by_side(const MatrixOperator& a, const MatrixOperator& b) {
  Eigen::MatrixXd exchange = Eigen::MatrixXd::Zero(a.size() + b.size(), a.size() + b.size());
  Eigen::VectorXd areas(a.size() + b.size());
  areas << Eigen::Map<const Eigen::VectorXd>(a.areas().data(), a.size()),
      Eigen::Map<const Eigen::VectorXd>(b.areas().data(), b.size());
  exchange.topLeftCorner(a.size(), a.size()) = a.rows();
  exchange.bottomRightCorner(b.size(), b.size()) = b.rows();
  return MatrixOperator::from_exchange_areas(areas.asDiagonal() * exchange, areas);
}

/// A closed enclosure of n patches with random couplings, areas over two orders, rows that sum to 1 to
/// rounding.
inline MatrixOperator random_enclosure(int n, unsigned seed, Precision precision = Precision::float64) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  Eigen::MatrixXd g(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      // a third of the pairs hidden from each other, the others over four orders of magnitude
      const double value = i == j || uniform(random) < 0.33 ? 0 : std::pow(10, -4 * uniform(random));
      g(i, j) = g(j, i) = value;
    }
  }
  const Eigen::VectorXd areas = g.rowwise().sum();  // rows of F sum to 1 by construction
  if (precision == Precision::float32) {
    for (int i = 0; i < n; ++i) {
      double rounding = 0;
      for (int j = 0; j < n; ++j) rounding += g(i, j) - static_cast<float>(g(i, j));
      g(i, i) = rounding;  // the diagonal closes what storing has rounded
    }
  }
  return MatrixOperator::from_exchange_areas(g, areas, precision);
}

}  // namespace luxel::test
