#include <vector>

#include "linear/exchange_rows.h"
#include "linear/methods.h"
#include "linear/row_kernels.h"

namespace luxel {

namespace {

/// Sweeps that read each stored exchange area once: row i gives the dot with the patches before i, and in the
/// same breath adds what B_i sends to them, which the next sweep needs. Vectors are column-major: one channel
/// at a time.
class Sweeps {
 public:
  Sweeps(const RadiositySystem& system, const PatchField& radiosity)
      : system_(system), exchange_(system.transport()), radiosity_(radiosity) {
    from_later_ = Eigen::MatrixXd::Zero(radiosity.rows(), radiosity.cols());
    for (int i = 0; i < exchange_.size(); ++i) {
      exchange_.lower_row(i, [&](const auto* row) {
        for (Eigen::Index c = 0; c < radiosity_.cols(); ++c) {
          add_scaled_row(row, radiosity_(i, c), from_later_.col(c).data(), i);
        }
      });
    }
  }

  /// Patches in order; E - B + K B afterwards.
  PatchField forward() {
    const Eigen::MatrixXd before = from_later_;
    from_later_.setZero();
    for (int i = 0; i < exchange_.size(); ++i) relax(i, before);
    PatchField residual = (from_later_ - before).cwiseProduct(system_.reflectance());
    for (Eigen::Index i = 0; i < residual.rows(); ++i) residual.row(i) /= system_.areas()[i];
    return residual;
  }

  /// Patches in reverse order.
  void backward() {
    from_later_.setZero();
    for (int i = exchange_.size() - 1; i >= 0; --i) relax(i, from_later_);
  }

  PatchField radiosity() const { return radiosity_; }

 private:
  void relax(int i, const Eigen::MatrixXd& from_later) {
    const double area = system_.areas()[i];
    exchange_.lower_row(i, [&](const auto* row) {
      for (Eigen::Index c = 0; c < radiosity_.cols(); ++c) {
        const double rho = system_.reflectance()(i, c);
        const double arriving = dot_row(row, radiosity_.col(c).data(), i) + from_later(i, c);
        radiosity_(i, c) =
            (system_.emission()(i, c) + rho * arriving / area) / (1 - rho * exchange_.diagonal(i) / area);
        add_scaled_row(row, radiosity_(i, c), from_later_.col(c).data(), i);
      }
    });
  }

  const RadiositySystem& system_;
  ExchangeRows exchange_;
  Eigen::MatrixXd radiosity_;
  Eigen::MatrixXd from_later_;  ///< sum over j > i of A_i F_ij B_j
};

}  // namespace

PatchField gauss_seidel(const RadiositySystem& system, PatchField radiosity, bool symmetric,
                        IterationWatch& watch) {
  watch.expect_decrease();
  if (!watch.start(system.residual(radiosity), radiosity)) return radiosity;
  Sweeps sweeps(system, radiosity);
  PatchField residual;
  do {
    if (symmetric) sweeps.backward();
    residual = sweeps.forward();
    radiosity = sweeps.radiosity();
  } while (watch.next(residual, radiosity));
  return radiosity;
}

}  // namespace luxel
