#include <cmath>
#include <limits>

#include "luxel/plan.h"
#include "plan/solved_channels.h"

namespace luxel {

namespace {

// Emissions that were written as multiples differ by the rounding of one product and one quotient.
constexpr double roundings = 4 * std::numeric_limits<double>::epsilon();

/// The s with `emission` = s * `source` on every patch; nothing where there is none.
std::optional<double> proportion(const Eigen::VectorXd& emission, const Eigen::VectorXd& source) {
  Eigen::Index brightest = 0;
  if (source.maxCoeff(&brightest) <= 0) return std::nullopt;
  const double factor = emission[brightest] / source[brightest];
  if (!(factor > 0) || !std::isfinite(factor)) return std::nullopt;
  const Eigen::ArrayXd expected = factor * source.array();
  const bool holds = ((emission.array() - expected).abs() <= roundings * expected).all();
  return holds ? std::optional(factor) : std::nullopt;
}

}  // namespace

ChannelPlan plan_channels(const PatchField& reflectance, const PatchField& emission,
                          const std::vector<char>& lossless) {
  ChannelPlan plan;
  for (Eigen::Index c = 0; c < emission.cols(); ++c) {
    int source = -1;
    double factor = 0;
    const bool dark = (emission.col(c).array() == 0).all() && !lossless[c];
    for (std::size_t k = 0; !dark && source < 0 && k < plan.solved.size(); ++k) {
      if (reflectance.col(plan.solved[k]) != reflectance.col(c)) continue;
      const auto found = proportion(emission.col(c), emission.col(plan.solved[k]));
      if (!found) continue;
      source = static_cast<int>(k);
      factor = *found;
    }
    if (!dark && source < 0) {
      source = static_cast<int>(plan.solved.size());
      factor = 1;
      plan.solved.push_back(static_cast<int>(c));
    }
    plan.source.push_back(source);
    plan.factors.push_back(factor);
  }
  return plan;
}

ChannelPlan every_channel(int count) {
  ChannelPlan plan;
  for (int c = 0; c < count; ++c) {
    plan.solved.push_back(c);
    plan.source.push_back(c);
    plan.factors.push_back(1);
  }
  return plan;
}

PatchField expanded(const PatchField& solved, const ChannelPlan& channels) {
  PatchField all = PatchField::Zero(solved.rows(), static_cast<Eigen::Index>(channels.source.size()));
  for (std::size_t c = 0; c < channels.source.size(); ++c) {
    if (channels.source[c] >= 0) all.col(c) = channels.factors[c] * solved.col(channels.source[c]);
  }
  return all;
}

}  // namespace luxel
