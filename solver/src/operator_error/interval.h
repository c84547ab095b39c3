#pragma once

#include <vector>

namespace luxel {

/// What an error is, and between what it lies.
struct Interval {
  double estimate = 0, low = 0, high = 0;
};

/// The interval of an RMS error from an estimate of its square, which noise may make negative.
/// @param without  the same, each without one of as many groups of the sample (jackknife)
/// @param noise    the standard error that it would have if there were no error
Interval error_interval(double square, const std::vector<double>& without, double noise);

}  // namespace luxel
