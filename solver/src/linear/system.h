#pragma once

#include <vector>

#include "luxel/transport_operator.h"
#include "luxel/vector.h"

namespace luxel {

/// What arrives on every patch, and by how much B misses its equation; N x m.
struct Balance {
  PatchField irradiance;
  PatchField residual;
};

/// The system B = E + K B, K = rho F, for m channels: what every method is given. It refers to its parts,
/// which must outlive it.
class RadiositySystem {
 public:
  RadiositySystem(const TransportOperator& transport, const PatchField& reflectance,
                  const PatchField& emission);

  const TransportOperator& transport() const { return *transport_; }
  const PatchField& reflectance() const { return *reflectance_; }
  const PatchField& emission() const { return *emission_; }
  Eigen::Index size() const { return emission_->rows(); }
  Eigen::Index columns() const { return emission_->cols(); }
  Eigen::Map<const Eigen::VectorXd> areas() const { return {transport_->areas().data(), size()}; }
  Eigen::Map<const Eigen::VectorXd> row_sums() const { return {transport_->row_sums().data(), size()}; }

  /// F X, N x m. Cost: one application of the operator.
  PatchField apply(const PatchField& x) const;
  /// H = F B with E - B + rho H. Cost: one application.
  Balance balance(const PatchField& radiosity) const;
  /// E - B + K B. Cost: one application.
  PatchField residual(const PatchField& radiosity) const { return balance(radiosity).residual; }

  /// Area-weighted ||r|| / ||E|| of each channel; 0 where E = 0 (B is exactly 0 there).
  Eigen::RowVectorXd relative_norms(const PatchField& residual) const;

  /// Channels with the same reflectance on every patch, which share K: lists of column numbers.
  std::vector<std::vector<Eigen::Index>> groups_of_equal_reflectance() const;

 private:
  const TransportOperator* transport_;
  const PatchField* reflectance_;
  const PatchField* emission_;
  Eigen::RowVectorXd emission_norm_;
};

}  // namespace luxel
