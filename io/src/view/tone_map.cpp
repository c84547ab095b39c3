#include "luxel/tone_map.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

namespace luxel {

namespace {

// End of the curve's straight part: a diffuse scene is shown in its true proportions, the fifth of the
// screen's range above (in sRGB) is left for lamps and what is close to them
constexpr double shoulder = 0.6;

constexpr double bright_share = 0.9;

// The median of the lit part comes at least here: 0.05 linear is 25 % grey on the screen, where detail shows
constexpr double least_median = 0.05;

double curve(double x) {
  if (x <= shoulder) return x;
  const double rest = 1 - shoulder;
  return shoulder + rest * (1 - std::exp(-(x - shoulder) / rest));
}

// The value that the given share of the weight does not exceed; `sorted` is not empty
double percentile(const std::vector<std::pair<double, double>>& sorted, double total, double share) {
  double below = 0;
  for (const auto& [value, weight] : sorted) {
    below += weight;
    if (below >= share * total) return value;
  }
  return sorted.back().first;
}

}  // namespace

double luminance(const Rgb& colour) {
  return 0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2];
}

double srgb_encoded(double linear) {
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 1;
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

Rgb ToneMap::linear(const Rgb& radiance) const {
  return radiance.unaryExpr(
      [this](double value) { return std::isnan(value) || value <= 0 ? 0.0 : curve(value * exposure); });
}

std::array<std::uint8_t, 3> ToneMap::operator()(const Rgb& radiance) const {
  const Rgb colour = linear(radiance);
  std::array<std::uint8_t, 3> bytes;
  for (int k = 0; k < 3; ++k)
    bytes[k] = static_cast<std::uint8_t>(std::lround(255 * srgb_encoded(colour[k])));
  return bytes;
}

ToneMap tone_map_for(std::span<const double> luminances, std::span<const double> weights) {
  if (!weights.empty() && weights.size() != luminances.size()) {
    throw std::invalid_argument("tone_map_for: as many weights as luminances, or none");
  }
  std::vector<std::pair<double, double>> lit;
  double total = 0;
  for (std::size_t i = 0; i < luminances.size(); ++i) {
    if (!std::isfinite(luminances[i]) || !(luminances[i] > 0)) continue;
    lit.emplace_back(luminances[i], weights.empty() ? 1 : weights[i]);
    total += lit.back().second;
  }
  if (lit.empty()) return {};
  std::sort(lit.begin(), lit.end());
  return {
      std::max(shoulder / percentile(lit, total, bright_share), least_median / percentile(lit, total, 0.5))};
}

}  // namespace luxel
