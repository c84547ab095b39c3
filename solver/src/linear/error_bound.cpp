#include "linear/error_bound.h"

#include <algorithm>
#include <cmath>

#include "linear/columns.h"
#include "linear/iteration_watch.h"
#include "linear/methods.h"

namespace luxel {

namespace {

constexpr double unit_roundoff = 0x1p-53;

// lambda of the probabilistic rounding bound: fails with probability 2 exp(-18) = 3e-8 a sum.
constexpr double rounding_confidence = 6;

// Sharpening costs about ten applications of F; it can gain up to the mean loss over the smallest.
constexpr double loss_ratio_worth_sharpening = 4;

// (I - K) v need only stay positive, so one digit is enough; the second try is for strong coupling.
constexpr double test_vector_tolerances[] = {1e-1, 1e-3};
constexpr int test_vector_iterations = 300;

}  // namespace

ErrorBound::ErrorBound(const RadiositySystem& system)
    : system_(&system),
      rounding_((rounding_confidence * std::sqrt(static_cast<double>(system.size())) + 4) * unit_roundoff),
      group_(system.columns()) {
  for (const auto& columns : system.groups_of_equal_reflectance()) {
    for (const Eigen::Index c : columns) group_[c] = static_cast<Eigen::Index>(first_.size());
    first_.push_back(columns.front());
  }
  largest_test_.setOnes(static_cast<Eigen::Index>(first_.size()));
  const PatchField returned =
      system.row_sums().asDiagonal() * PatchField(system.reflectance()(Eigen::all, first_));
  loss_ = (1 - returned.array()) - rounding_ * returned.array();
}

bool ErrorBound::exists() const {
  return loss_.size() == 0 || loss_.minCoeff() > 0;
}

bool ErrorBound::worth_sharpening() const {
  for (Eigen::Index g = 0; g < loss_.cols(); ++g) {
    const double smallest = loss_.col(g).minCoeff();
    if (smallest <= 0 || loss_.col(g).mean() > loss_ratio_worth_sharpening * smallest) return true;
  }
  return false;
}

void ErrorBound::sharpen() {
  const PatchField reflectance = system_->reflectance()(Eigen::all, first_);
  const PatchField ones = PatchField::Ones(reflectance.rows(), reflectance.cols());
  const RadiositySystem furnace(system_->transport(), reflectance, ones);
  for (const double tolerance : test_vector_tolerances) {
    SolveOptions options;
    options.tolerance = tolerance;
    options.max_iterations = test_vector_iterations;
    SolveReport report;
    IterationWatch watch(furnace, options, nullptr, report);
    const bool symmetric = system_->transport().symmetric();
    const PatchField v = symmetric ? cg(furnace, ones, watch) : gmres(furnace, ones, options.restart, watch);
    if (!v.allFinite()) return;
    const PatchField returned = reflectance.cwiseProduct(furnace.apply(v));
    const PatchField w = (v - returned) - rounding_ * (v.cwiseAbs() + returned.cwiseAbs());
    for (Eigen::Index g = 0; g < v.cols(); ++g) {
      const double smallest = w.col(g).minCoeff();
      if (smallest <= 0 || v.col(g).minCoeff() <= 0) continue;
      const double gain = v.col(g).maxCoeff() / smallest;
      if (loss_.col(g).minCoeff() > 0 && largest_test_[g] / loss_.col(g).minCoeff() <= gain) continue;
      loss_.col(g) = w.col(g);
      largest_test_[g] = v.col(g).maxCoeff();
    }
    if (exists()) return;
  }
}

double ErrorBound::channel(const PatchField& residual, const PatchField& radiosity, Eigen::Index c) const {
  const auto& emission = system_->emission();
  const Eigen::Index group = group_[c];
  double largest_share = 0;  // of (|r_i| + its rounding) / w_i
  double largest_radiosity = 0;
  for (Eigen::Index i = 0; i < residual.rows(); ++i) {
    const double r = std::abs(residual(i, c));
    const double reflected = std::abs(radiosity(i, c) - emission(i, c));
    if (r > 0 || reflected > 0) {
      if (!(loss_(i, group) > 0)) return std::numeric_limits<double>::infinity();
      const double rounding = rounding_ * (reflected + r) + 2 * unit_roundoff * std::abs(radiosity(i, c));
      const double share = (r + rounding) / loss_(i, group);
      if (!(share <= largest_share)) largest_share = share;  // keeps a NaN
    } else if (!(loss_(i, group) > 0)) {
      // a vanishing residual proves nothing where no test vector shows the solution to be unique
      return std::numeric_limits<double>::infinity();
    }
    largest_radiosity = std::max(largest_radiosity, std::abs(radiosity(i, c)));
  }
  const double bound = largest_share * largest_test_[group];
  if (bound == 0) return 0;
  // B* >= E >= 0 for a nonsingular M-matrix, and max |B*| >= max |B| - bound
  const double smallest_scale = std::max(largest_radiosity - bound, emission.col(c).maxCoeff());
  return smallest_scale > 0 && std::isfinite(bound) ? bound / smallest_scale
                                                    : std::numeric_limits<double>::infinity();
}

double ErrorBound::relative(const PatchField& residual, const PatchField& radiosity) const {
  double worst = 0;
  for (Eigen::Index c = 0; c < residual.cols(); ++c) {
    worst = std::max(worst, channel(residual, radiosity, c));
  }
  return worst;
}

}  // namespace luxel
