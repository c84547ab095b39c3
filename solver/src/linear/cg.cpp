#include <Eigen/Eigenvalues>
#include <cmath>
#include <vector>

#include "linear/columns.h"
#include "linear/methods.h"

namespace luxel {

namespace {

// More Lanczos coefficients than these add nothing to an estimate of the condition number.
constexpr std::size_t lanczos_steps = 100;

// Patches below this reflect nothing that float64 could tell from rounding, and A / rho must not overflow.
constexpr double least_reflectance = 1e-100;

// A column whose <r, r> has fallen by this share of its start is far below rounding and is left alone, before
// it underflows.
constexpr double exhausted_share = 1e-40;

/// Condition number of the tridiagonal matrix that conjugate gradients with these step lengths have built
/// (Golub and Van Loan 2013, 11.3.5); its eigenvalues lie between those of the system.
double condition_of_lanczos(const std::vector<double>& alpha, const std::vector<double>& beta) {
  const Eigen::Index k = static_cast<Eigen::Index>(alpha.size());
  if (k == 0) return 0;
  Eigen::VectorXd diagonal(k), subdiagonal(std::max<Eigen::Index>(k - 1, 0));
  for (Eigen::Index i = 0; i < k; ++i) {
    diagonal[i] = 1 / alpha[i] + (i > 0 ? beta[i - 1] / alpha[i - 1] : 0);
    if (i + 1 < k) subdiagonal[i] = std::sqrt(beta[i]) / alpha[i];
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen;
  eigen.computeFromTridiagonal(diagonal, subdiagonal, Eigen::EigenvaluesOnly);
  const double smallest = eigen.eigenvalues().minCoeff();
  return smallest > 0 ? eigen.eigenvalues().maxCoeff() / smallest : 0;
}

}  // namespace

// I - K is self-adjoint in the inner product <x, y> = sum_i A_i / rho_i x_i y_i over the patches with rho >
// 0, where all the vectors below live. That is the same as the symmetric system A / rho - A F with the
// diagonal preconditioner rho / A, and r is the residual of B itself.
PatchField cg(const RadiositySystem& system, PatchField radiosity, IterationWatch& watch) {
  const Eigen::Index m = system.columns();
  const auto& rho = system.reflectance();
  const auto areas = system.areas();
  PatchField weights(system.size(), m);
  for (Eigen::Index c = 0; c < m; ++c) {
    weights.col(c) = (rho.col(c).array() > least_reflectance).select(areas.array() / rho.col(c).array(), 0);
  }

  PatchField residual = system.residual(radiosity);
  if (!watch.start(residual, radiosity)) return radiosity;
  PatchField direction = residual;
  Eigen::RowVectorXd rr = weighted_dots(weights, residual, residual);
  const Eigen::RowVectorXd exhausted = exhausted_share * rr;
  std::vector<std::vector<double>> alphas(m), betas(m);
  bool go_on = true;
  while (go_on) {
    PatchField image = system.apply(direction);
    image = direction - rho.cwiseProduct(image);
    const Eigen::RowVectorXd curvature = weighted_dots(weights, direction, image);
    Eigen::RowVectorXd alpha(m);
    for (Eigen::Index c = 0; c < m; ++c) {
      if (rr[c] > exhausted[c] && curvature[c] <= 0) {
        watch.stop(Stopped::diverged, "the system is not positive definite at iteration " +
                                          std::to_string(watch.report().iterations + 1) +
                                          ": the operator returns more light than it is given");
        return radiosity;
      }
      alpha[c] = rr[c] > exhausted[c] ? rr[c] / curvature[c] : 0;
    }
    for_row_blocks(system.size(), [&](Eigen::Index first, Eigen::Index count) {
      for (Eigen::Index i = first; i < first + count; ++i) {
        radiosity.row(i) += alpha.cwiseProduct(direction.row(i));
        residual.row(i) -= alpha.cwiseProduct(image.row(i));
      }
    });
    const Eigen::RowVectorXd rr_next = weighted_dots(weights, residual, residual);
    Eigen::RowVectorXd beta(m);
    for (Eigen::Index c = 0; c < m; ++c) {
      beta[c] = rr[c] > exhausted[c] ? rr_next[c] / rr[c] : 0;
      if (rr[c] > exhausted[c] && alphas[c].size() < lanczos_steps) {
        alphas[c].push_back(alpha[c]);
        betas[c].push_back(beta[c]);
      }
    }
    rr = rr_next;
    go_on = watch.next(residual, radiosity);
    for_row_blocks(system.size(), [&](Eigen::Index first, Eigen::Index count) {
      for (Eigen::Index i = first; i < first + count; ++i) {
        direction.row(i) = residual.row(i) + beta.cwiseProduct(direction.row(i));
      }
    });
  }
  for (Eigen::Index c = 0; c < m; ++c) {
    watch.report().condition_estimate =
        std::max(watch.report().condition_estimate, condition_of_lanczos(alphas[c], betas[c]));
  }
  return radiosity;
}

}  // namespace luxel
