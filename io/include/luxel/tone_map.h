#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "luxel/vector.h"

namespace luxel {

/// Luminance of a linear Rec. 709 colour, in the colour's own unit: 0.2126 R + 0.7152 G + 0.0722 B.
double luminance(const Rgb& colour);

/// From radiance to the 8-bit sRGB of a screen: exposure, a curve for each channel that is straight up to 0.6
/// and bends softly towards 1 above, and the sRGB transfer function (IEC 61966-2-1). What is very bright
/// turns white.
struct ToneMap {
  double exposure = 1;  ///< factor on radiance, > 0 [m2 sr / W]

  /// Linear display colour, each channel in [0, 1]. Negative channels and NaN count as 0.
  Rgb linear(const Rgb& radiance) const;
  /// The same in 8-bit sRGB, rounded.
  std::array<std::uint8_t, 3> operator()(const Rgb& radiance) const;
};

/// The tone map that brings the luminance which 90 % of what is lit does not exceed to the end of the curve's
/// straight part, 0.6; but where this leaves the median of what is lit below 0.05, the one that brings the
/// median there. Zeros do not count, nor does what is not finite; exposure 1 where nothing is lit.
/// @param luminances  of pixels or patches
/// @param weights     as many (patch areas), or none: all equal
/// @throws std::invalid_argument if the two have different lengths
ToneMap tone_map_for(std::span<const double> luminances, std::span<const double> weights = {});

/// The sRGB transfer function, from linear [0, 1] to [0, 1]; outside it is held at the ends.
double srgb_encoded(double linear);

}  // namespace luxel
