#include "linear/system.h"

#include "linear/columns.h"

namespace luxel {

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

PatchField RadiositySystem::residual(const PatchField& radiosity, const PatchField& irradiance) const {
  PatchField residual(size(), columns());
  for_row_blocks(size(), [&](Eigen::Index first, Eigen::Index count) {
    const auto rows = [&](const PatchField& field) { return field.middleRows(first, count).array(); };
    residual.middleRows(first, count) =
        (rows(*emission_) - rows(radiosity)) + rows(*reflectance_) * rows(irradiance);
  });
  return residual;
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
