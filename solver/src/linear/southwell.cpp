#include <algorithm>
#include <vector>

#include "linear/exchange_rows.h"
#include "linear/methods.h"
#include "linear/row_kernels.h"

namespace luxel {

namespace {

/// The exchange areas as a full square, so that a shot reads one row of it. Memory: twice the operator's.
template <class Real>
class Square {
 public:
  explicit Square(const ExchangeMatrix& entries) : size_(entries.size()) {
    values_.resize(static_cast<std::size_t>(size_) * size_);
    for (int i = 0; i < size_; ++i) {
      const Real* lower = entries.row<Real>(i);
      for (int j = 0; j < i; ++j) values_[at(i, j)] = values_[at(j, i)] = lower[j];
    }
  }
  const Real* row(int i) const { return &values_[at(i, 0)]; }

 private:
  std::size_t at(int i, int j) const { return static_cast<std::size_t>(i) * size_ + j; }
  int size_;
  std::vector<Real> values_;
};

/// Light that has been shot, and what waits to be; column-major.
struct Light {
  Eigen::MatrixXd shot;    ///< the B of the system, whose residual is:
  Eigen::MatrixXd unshot;  ///< E - B + K B
};

/// The patch with the most unshot power, sum over channels of A_i |dB_i| [W]; -1 where all is shot.
int brightest(const Light& light, const Eigen::VectorXd& areas) {
  const Eigen::VectorXd power = light.unshot.cwiseAbs().rowwise().sum().cwiseProduct(areas);
  const double most = power.maxCoeff();
  if (!(most > 0)) return -1;
  return static_cast<int>(std::find(power.data(), power.data() + power.size(), most) - power.data());
}

/// Shoots the unshot light of patch i in all channels. `gain` is rho_j / A_j.
template <class Real>
void shoot(int i, const Square<Real>& exchange, double diagonal, const Eigen::MatrixXd& gain, Light& light) {
  const Real* row = exchange.row(i);
  for (Eigen::Index c = 0; c < light.unshot.cols(); ++c) {
    const double power = light.unshot(i, c);
    if (power == 0) continue;
    light.shot(i, c) += power;
    light.unshot(i, c) = power * gain(i, c) * diagonal;
    double* unshot = light.unshot.col(c).data();
    const double* reflected = gain.col(c).data();
    for (Eigen::Index j = 0; j < light.unshot.rows(); ++j) {
      unshot[j] += power * reflected[j] * static_cast<double>(row[j]);
    }
  }
}

template <class Real>
PatchField shoot_all(const RadiositySystem& system, PatchField radiosity, IterationWatch& watch) {
  PatchField residual = system.residual(radiosity);
  if (!watch.start(residual, radiosity)) return radiosity;
  const Square<Real> exchange(*system.transport().entries());
  const ExchangeRows entries(system.transport());
  const Eigen::VectorXd areas = system.areas();
  const Eigen::MatrixXd gain = areas.cwiseInverse().asDiagonal() * Eigen::MatrixXd(system.reflectance());
  do {
    Light light{radiosity, residual};
    for (Eigen::Index shot = 0; shot < system.size(); ++shot) {
      const int i = brightest(light, areas);
      if (i < 0) break;
      shoot(i, exchange, entries.diagonal(i), gain, light);
    }
    radiosity = light.shot;
    residual = system.residual(radiosity);  // sheds the rounding of so many small additions
  } while (watch.next(residual, radiosity));
  return radiosity;
}

}  // namespace

PatchField southwell(const RadiositySystem& system, PatchField radiosity, IterationWatch& watch) {
  watch.expect_decrease();
  const bool small = system.transport().entries()->precision() == Precision::float32;
  return small ? shoot_all<float>(system, std::move(radiosity), watch)
               : shoot_all<double>(system, std::move(radiosity), watch);
}

}  // namespace luxel
