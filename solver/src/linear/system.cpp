#include "linear/system.h"

#include <algorithm>
#include <cmath>

#include "linear/columns.h"

namespace luxel {

namespace {

// Within a factor of two B - c is exact (Sterbenz 1974), and nobody is faint beside the level.
constexpr double uniform_ratio = 0.5;

/// The middle of each column that is uniform within a factor of two, 0 for the others.
Eigen::RowVectorXd uniform_level(const PatchField& radiosity) {
  Eigen::RowVectorXd level = Eigen::RowVectorXd::Zero(radiosity.cols());
  if (radiosity.rows() == 0) return level;
  const Eigen::RowVectorXd least = radiosity.colwise().minCoeff(), most = radiosity.colwise().maxCoeff();
  for (Eigen::Index c = 0; c < level.size(); ++c) {
    if (least[c] > 0 && least[c] >= uniform_ratio * most[c]) level[c] = 0.5 * (least[c] + most[c]);
  }
  return level;
}

}  // namespace

RadiositySystem::RadiositySystem(const TransportOperator& transport, const PatchField& reflectance,
                                 const PatchField& emission)
    : transport_(&transport),
      reflectance_(&reflectance),
      emission_(&emission),
      emission_norm_(weighted_dots(areas(), emission, emission).cwiseSqrt()) {}

PatchField RadiositySystem::apply(const PatchField& x) const {
  PatchField y(x.rows(), x.cols());
  transport_->apply(x.data(), y.data(), static_cast<int>(x.cols()));
  return y;
}

// Where B is nearly uniform, as in white rooms, F B is c s + F (B - c) for a level c, and the residual
// (E - (B - c)) - c (1 - rho s) + rho F (B - c): its rounding is that of E and B - c, not of B, which may be
// 1 / (1 - rho) times larger. Where B is not, subtracting a level would drown the faint patches, so that c =
// 0.
Balance RadiositySystem::balance(const PatchField& radiosity) const {
  const Eigen::RowVectorXd level = uniform_level(radiosity);
  const PatchField variation = radiosity.rowwise() - level;
  const auto sums = row_sums();
  Balance balance{apply(variation), PatchField(size(), columns())};
  for_row_blocks(size(), [&](Eigen::Index first, Eigen::Index count) {
    for (Eigen::Index i = first; i < first + count; ++i) {
      for (Eigen::Index c = 0; c < columns(); ++c) {
        const double rho = (*reflectance_)(i, c), emitted = (*emission_)(i, c);
        const double lost = level[c] * std::fma(-rho, sums[i], 1.0);
        double& irradiance = balance.irradiance(i, c);
        // B = E where nothing reflects, exactly
        balance.residual(i, c) =
            rho == 0 ? emitted - radiosity(i, c) : (emitted - variation(i, c)) - lost + rho * irradiance;
        irradiance += level[c] * sums[i];
      }
    }
  });
  return balance;
}

Eigen::RowVectorXd RadiositySystem::relative_norms(const PatchField& residual) const {
  Eigen::RowVectorXd norms = weighted_dots(areas(), residual, residual).cwiseSqrt();
  for (Eigen::Index c = 0; c < norms.size(); ++c) {
    if (norms[c] != 0) norms[c] /= emission_norm_[c];
  }
  return norms;
}

std::vector<std::vector<Eigen::Index>> RadiositySystem::groups_of_equal_reflectance() const {
  std::vector<std::vector<Eigen::Index>> groups;
  for (Eigen::Index c = 0; c < columns(); ++c) {
    const auto same = [&](const auto& group) {
      return reflectance_->col(group.front()) == reflectance_->col(c);
    };
    const auto found = std::find_if(groups.begin(), groups.end(), same);
    if (found == groups.end()) {
      groups.push_back({c});
    } else {
      found->push_back(c);
    }
  }
  return groups;
}

}  // namespace luxel
