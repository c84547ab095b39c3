#include <cmath>
#include <memory>

#include "linear/exchange_rows.h"
#include "linear/factor/cholesky_factor.h"
#include "linear/factor/refinement.h"
#include "linear/methods.h"

namespace luxel {

namespace {

/// I - D A F D^-1 .. of one reflectance, D = sqrt(A / rho): symmetric, with a unit diagonal but for F_ii,
/// over the patches that reflect.
struct SymmetricForm {
  std::vector<int> patches;  ///< with rho > 0
  Eigen::VectorXd scale;     ///< sqrt(A / rho) of these
};

SymmetricForm symmetric_form(const RadiositySystem& system, Eigen::Index column) {
  SymmetricForm form;
  for (int i = 0; i < system.size(); ++i) {
    if (system.reflectance()(i, column) > 0) form.patches.push_back(i);
  }
  form.scale.resize(static_cast<Eigen::Index>(form.patches.size()));
  for (std::size_t a = 0; a < form.patches.size(); ++a) {
    const int i = form.patches[a];
    form.scale[a] = std::sqrt(system.areas()[i] / system.reflectance()(i, column));
  }
  return form;
}

template <class Real>
std::shared_ptr<CholeskyFactor<Real>> factor(const RadiositySystem& system, const SymmetricForm& form) {
  const ExchangeRows exchange(system.transport());
  const Eigen::VectorXd inverse = form.scale.cwiseInverse();
  auto result =
      std::make_shared<CholeskyFactor<Real>>(static_cast<int>(form.patches.size()), [&](int a, Real* row) {
        exchange.lower_row(form.patches[a], [&](const auto* exchange_row) {
          // patches are in order, so that the ones before a are in the lower triangle
          for (int b = 0; b < a; ++b) {
            const double g = static_cast<double>(exchange_row[form.patches[b]]);
            row[b] = static_cast<Real>(-g * (inverse[a] * inverse[b]));
          }
        });
        row[a] = static_cast<Real>(1 - exchange.diagonal(form.patches[a]) * (inverse[a] * inverse[a]));
      });
  return result->factor() ? result : nullptr;
}

/// dB of the columns of one group.
template <class Real>
void correct(const SymmetricForm& form, const CholeskyFactor<Real>& factor,
             const std::vector<Eigen::Index>& columns, const PatchField& residual, PatchField& correction) {
  const Eigen::Index n = static_cast<Eigen::Index>(form.patches.size()),
                     m = static_cast<Eigen::Index>(columns.size());
  typename CholeskyFactor<Real>::Block x(n, m);
  for (Eigen::Index k = 0; k < m; ++k) {
    Eigen::VectorXd scaled(n);
    for (Eigen::Index a = 0; a < n; ++a) scaled[a] = form.scale[a] * residual(form.patches[a], columns[k]);
    const double size = n > 0 ? scaled.cwiseAbs().maxCoeff() : 0;
    x.col(k) = (size > 0 ? Eigen::VectorXd(scaled / size) : scaled).template cast<Real>();
    for (Eigen::Index a = 0; a < n; ++a) correction(form.patches[a], columns[k]) = size / form.scale[a];
  }
  factor.solve(x);
  for (Eigen::Index k = 0; k < m; ++k) {
    for (Eigen::Index a = 0; a < n; ++a) correction(form.patches[a], columns[k]) *= x(a, k);
  }
}

template <class Real>
Correction corrections(const RadiositySystem& system) {
  struct Part {
    std::vector<Eigen::Index> columns;
    SymmetricForm form;
    std::shared_ptr<CholeskyFactor<Real>> factor;
  };
  auto parts = std::make_shared<std::vector<Part>>();
  for (auto& columns : system.groups_of_equal_reflectance()) {
    SymmetricForm form = symmetric_form(system, columns.front());
    auto made = factor<Real>(system, form);
    if (!made) return nullptr;
    parts->push_back({std::move(columns), std::move(form), std::move(made)});
  }
  return [parts](const PatchField& residual) {
    PatchField correction = PatchField::Zero(residual.rows(), residual.cols());
    for (const Part& part : *parts) correct(part.form, *part.factor, part.columns, residual, correction);
    return correction;
  };
}

}  // namespace

PatchField cholesky(const RadiositySystem& system, PatchField radiosity, IterationWatch& watch) {
  const Factorisation factorise = [&](FactorPrecision precision) {
    return precision == FactorPrecision::float32 ? corrections<float>(system) : corrections<double>(system);
  };
  return refine(system, std::move(radiosity), factorise, watch);
}

}  // namespace luxel
