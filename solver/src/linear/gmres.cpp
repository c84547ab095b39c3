#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "linear/columns.h"
#include "linear/methods.h"

namespace luxel {

namespace {

// Gram-Schmidt is done twice, after which the directions are orthogonal to rounding (Giraud et al. 2005).
constexpr int orthogonalisations = 2;

/// The least-squares problem of one column: H y = ||r|| e_1 with Givens rotations, as it grows.
struct Hessenberg {
  Eigen::MatrixXd r;    ///< upper triangle after the rotations
  Eigen::VectorXd rhs;  ///< its last entry is the residual's norm
  std::vector<Eigen::JacobiRotation<double>> rotations;

  Hessenberg(int restart, double norm) : r(Eigen::MatrixXd::Zero(restart + 1, restart)), rhs(restart + 1) {
    rhs.setZero();
    rhs[0] = norm;
  }

  /// Takes the next column, of size k + 2.
  void add(int k, Eigen::VectorXd column) {
    for (int i = 0; i < k; ++i) column.applyOnTheLeft(i, i + 1, rotations[i].adjoint());
    Eigen::JacobiRotation<double> rotation;
    rotation.makeGivens(column[k], column[k + 1]);
    column.applyOnTheLeft(k, k + 1, rotation.adjoint());
    rhs.applyOnTheLeft(k, k + 1, rotation.adjoint());
    rotations.push_back(rotation);
    r.col(k).head(k + 2) = column;
  }

  Eigen::VectorXd solution(int k) const {
    // a column that had converged exactly has zeros from there on
    Eigen::VectorXd y = Eigen::VectorXd::Zero(k);
    for (int i = k - 1; i >= 0; --i) {
      const double rest = rhs[i] - r.row(i).segment(i + 1, k - i - 1).dot(y.segment(i + 1, k - i - 1));
      y[i] = r(i, i) != 0 ? rest / r(i, i) : 0;
    }
    return y;
  }
};

Eigen::RowVectorXd inverse_or_zero(const Eigen::RowVectorXd& x) {
  return (x.array() > 0).select(x.array().inverse(), 0);
}

}  // namespace

// All columns build their own directions in step, in the area-weighted inner product, so that the norm that
// falls is the one of the stopping rule.
PatchField gmres(const RadiositySystem& system, PatchField radiosity, int restart, IterationWatch& watch) {
  const Eigen::Index n = system.size(), m = system.columns();
  const auto areas = system.areas();
  const Eigen::RowVectorXd emission_norm =
      weighted_dots(areas, system.emission(), system.emission()).cwiseSqrt();

  PatchField residual = system.residual(radiosity);
  if (!watch.start(residual, radiosity)) return radiosity;
  while (true) {
    const Eigen::RowVectorXd norm = weighted_dots(areas, residual, residual).cwiseSqrt();
    std::vector<PatchField> directions{residual * inverse_or_zero(norm).asDiagonal()};
    std::vector<Hessenberg> columns;
    for (Eigen::Index c = 0; c < m; ++c) columns.emplace_back(restart, norm[c]);

    // below the rounding of B the recurrence says nothing about the residual
    const double rounding = 0x1p-53 * system.relative_norms(radiosity).maxCoeff();
    const double target = std::max(watch.target(), rounding);
    int k = 0;
    bool cycle = true;
    while (cycle) {
      const PatchField& last = directions.back();
      PatchField next = last - system.reflectance().cwiseProduct(system.apply(last));
      const Eigen::RowVectorXd size = weighted_dots(areas, next, next).cwiseSqrt();
      Eigen::MatrixXd h = Eigen::MatrixXd::Zero(k + 2, m);
      for (int pass = 0; pass < orthogonalisations; ++pass) {
        for (int j = 0; j <= k; ++j) {
          const Eigen::RowVectorXd share = weighted_dots(areas, directions[j], next);
          h.row(j) += share;
          next -= directions[j] * share.asDiagonal();
        }
      }
      Eigen::RowVectorXd rest = weighted_dots(areas, next, next).cwiseSqrt();
      // what is left is rounding: the directions span the solution
      rest = (rest.array() > 1e-14 * size.array()).select(rest, 0);
      h.row(k + 1) = rest;
      directions.push_back(next * inverse_or_zero(rest).asDiagonal());
      Eigen::RowVectorXd relative(m);
      for (Eigen::Index c = 0; c < m; ++c) {
        columns[c].add(k, h.col(c));
        const double left = std::abs(columns[c].rhs[k + 1]);
        relative[c] = left == 0 ? 0 : left / emission_norm[c];
      }
      ++k;
      cycle = k < restart && relative.maxCoeff() > target && rest.maxCoeff() > 0;
      if (cycle && !watch.next(relative)) break;
    }

    PatchField step = PatchField::Zero(n, m);
    Eigen::MatrixXd y(k, m);
    for (Eigen::Index c = 0; c < m; ++c) y.col(c) = columns[c].solution(k);
    for (int j = 0; j < k; ++j) step += directions[j] * y.row(j).asDiagonal();
    radiosity += step;
    residual = system.residual(radiosity);
    if (cycle || !watch.next(residual, radiosity)) return radiosity;
  }
}

}  // namespace luxel
