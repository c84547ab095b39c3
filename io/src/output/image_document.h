#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace luxel {

enum class ChannelType { uint8, uint32, float32 };

/// What an image file holds, with no type of OpenImageIO's: handed to the module that encodes it.
struct ImageDocument {
  struct Channel {
    std::string name;
    ChannelType type;
  };
  std::string format;  ///< "exr", "hdr" or "png"
  int width = 0;
  int height = 0;
  std::vector<Channel> channels;
  std::vector<std::byte> pixels;  ///< rows from the top, channels of a pixel together, packed
  std::string colour_space;       ///< "Linear" or "sRGB"
  std::vector<std::pair<std::string, std::string>> metadata;
};

/// Bytes of a file, or why there are none.
struct EncodedImage {
  std::vector<unsigned char> bytes;
  std::string trouble;  ///< empty: none
};

using ImageEncoder = EncodedImage (*)(const ImageDocument& document);

/// The symbol of the module luxel_image that holds its ImageEncoder; its number changes with ImageDocument.
constexpr const char* image_encoder_symbol = "luxel_image_encoder_1";

}  // namespace luxel
