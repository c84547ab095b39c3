#include "operator_error/interval.h"

#include <algorithm>
#include <cmath>

namespace luxel {

namespace {

// The quantile of Student's t for 31 degrees of freedom: 99.5 %, since squares of errors have long tails of
// which a sample often holds too little (docs/scale.md counts what holds).
constexpr double quantile = 2.74;

// The same for noise below the low end, which must not make an error where there is none: a product of two
// noises has longer tails than a normal deviate.
constexpr double noise_quantile = 4;

// With a larger relative deviation the square is that of a patch or two, which may be the only ones.
constexpr double few_squares = 0.7;

// What the probes themselves may be wrong by, relative to the irradiance.
constexpr double own_error = 2e-5;

}  // namespace

Interval error_interval(double square, const std::vector<double>& without, double noise) {
  const double count = static_cast<double>(without.size());
  double mean = 0, scatter = 0;
  for (const double x : without) mean += x / count;
  for (const double x : without) scatter += (x - mean) * (x - mean);
  const double deviation = std::sqrt(scatter * (count - 1) / count);
  Interval interval;
  interval.estimate = std::sqrt(std::max(0.0, square));
  // squares scatter as their logarithms do: exp(reach / square) to second order, up to where it says nothing
  const double reach = quantile * deviation;
  const double above = reach > 0 ? reach + reach * reach / (2 * std::max(square, reach)) : 0;
  interval.high = std::sqrt(std::max(0.0, square) + above + own_error * own_error);
  // noise may make a square out of nothing; which patches were drawn makes it larger or smaller
  double low = 0;
  if (deviation < few_squares * square) {
    const double drawn = std::sqrt(std::max(0.0, deviation * deviation - noise * noise));
    low = (square - noise_quantile * noise) * std::exp(-quantile * drawn / square);
  }
  interval.low = std::sqrt(std::max(0.0, low - own_error * own_error));
  return interval;
}

}  // namespace luxel
