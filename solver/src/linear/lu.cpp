#include <tbb/parallel_for.h>

#include <memory>

#include "linear/exchange_rows.h"
#include "linear/factor/lu_factor.h"
#include "linear/factor/refinement.h"
#include "linear/methods.h"

namespace luxel {

namespace {

/// I - K of one column's reflectance over the patches that reflect, factored; null where it is singular.
template <class Real>
std::shared_ptr<LuFactor<Real>> factor(const RadiositySystem& system, const std::vector<int>& patches,
                                       Eigen::Index column) {
  const ExchangeRows exchange(system.transport());
  const int n = static_cast<int>(patches.size());
  Eigen::VectorXd reflected(n);  // rho_i / A_i
  for (int a = 0; a < n; ++a)
    reflected[a] = system.reflectance()(patches[a], column) / system.areas()[patches[a]];
  auto result = std::make_shared<LuFactor<Real>>(n);
  tbb::parallel_for(0, n, [&](int a) {
    Real* above = result->column(a);
    exchange.lower_row(patches[a], [&](const auto* row) {
      for (int b = 0; b < a; ++b) {
        const double g = static_cast<double>(row[patches[b]]);
        above[b] = static_cast<Real>(-reflected[b] * g);
        result->column(b)[a] = static_cast<Real>(-reflected[a] * g);
      }
    });
    above[a] = static_cast<Real>(1 - reflected[a] * exchange.diagonal(patches[a]));
  });
  return result->factor() ? result : nullptr;
}

template <class Real>
Correction corrections(const RadiositySystem& system) {
  struct Part {
    std::vector<Eigen::Index> columns;
    std::vector<int> patches;  ///< with rho > 0
    std::shared_ptr<LuFactor<Real>> factor;
  };
  auto parts = std::make_shared<std::vector<Part>>();
  for (auto& columns : system.groups_of_equal_reflectance()) {
    std::vector<int> patches;
    for (int i = 0; i < system.size(); ++i) {
      if (system.reflectance()(i, columns.front()) > 0) patches.push_back(i);
    }
    auto made = factor<Real>(system, patches, columns.front());
    if (!made) return nullptr;
    parts->push_back({std::move(columns), std::move(patches), std::move(made)});
  }
  return [parts](const PatchField& residual) {
    PatchField correction = PatchField::Zero(residual.rows(), residual.cols());
    for (const auto& [columns, patches, factor] : *parts) {
      // scaled to 1, so that nothing leaves the range of float32
      const Eigen::MatrixXd right = residual(patches, columns);
      Eigen::RowVectorXd size = Eigen::RowVectorXd::Ones(right.cols());
      if (right.rows() > 0) size = right.cwiseAbs().colwise().maxCoeff();
      size = (size.array() > 0).select(size, 1);
      typename LuFactor<Real>::Block x = (right * size.cwiseInverse().asDiagonal()).template cast<Real>();
      factor->solve(x);
      correction(patches, columns) = x.template cast<double>() * size.asDiagonal();
    }
    return correction;
  };
}

}  // namespace

PatchField lu(const RadiositySystem& system, PatchField radiosity, IterationWatch& watch) {
  const Factorisation factorise = [&](FactorPrecision precision) {
    return precision == FactorPrecision::float32 ? corrections<float>(system) : corrections<double>(system);
  };
  return refine(system, std::move(radiosity), factorise, watch);
}

}  // namespace luxel
