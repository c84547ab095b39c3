#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "luxel/tone_map.h"

namespace luxel {

/// A view as numbers: rows from top to bottom, pixels from left to right.
struct Image {
  static constexpr int nothing = -1;  ///< `patch` where no patch is seen

  int width = 0;
  int height = 0;
  std::vector<float>
      rgb;  ///< width x height x 3, radiance in linear Rec. 709 [W/(m2 sr)]; black: nothing there
  std::vector<float>
      depth;  ///< distance from the eye's plane [m] at the pixel's centre; infinity: nothing there
  std::vector<int> patch;  ///< what the pixel's centre shows, or `nothing`

  Rgb pixel(int x, int y) const {
    const float* at = rgb.data() + 3 * (static_cast<std::size_t>(y) * width + x);
    return Rgb(at[0], at[1], at[2]);
  }
};

struct ImageOptions {
  std::optional<ToneMap> tone_map = std::nullopt;  ///< of .png; without it tone_map_for(image)
  /// Written into .exr and .png as text, in this order: {"Software", "luxel 1.0"}, {"luxel:scene",
  /// "room.obj"}, ...
  std::vector<std::pair<std::string, std::string>> metadata = {};
};

/// The tone map for the image's pixels, all weighing the same.
ToneMap tone_map_for(const Image& image);

/// Writes an image; the extension chooses: .exr (float32 R, G, B and, where the image has them, Z and
/// `patch`; zip), .hdr (Radiance RGBE: R, G, B to 1 %), .png (8-bit sRGB, tone-mapped). Whole or not at all
/// (OutputFile). The same image and options give the same bytes.
/// @throws InputError where the file cannot be written, has another extension, or the module luxel_image is
/// missing
/// @throws std::invalid_argument if the arrays do not fit width and height
void write_image(const std::filesystem::path& path, const Image& image, const ImageOptions& options = {});

}  // namespace luxel
