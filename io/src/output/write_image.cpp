#include <cstring>
#include <stdexcept>

#include "extension.h"
#include "image_document.h"
#include "luxel/image.h"
#include "luxel/input_error.h"
#include "luxel/write_file.h"
#include "module.h"

namespace luxel {

namespace {

std::size_t pixel_count(const Image& image) {
  return static_cast<std::size_t>(image.width) * image.height;
}

void require_whole(const Image& image) {
  const std::size_t pixels = pixel_count(image);
  const auto fits = [&](std::size_t size) { return size == 0 || size == pixels; };
  if (image.width < 1 || image.height < 1 || image.rgb.size() != 3 * pixels || !fits(image.depth.size()) ||
      !fits(image.patch.size())) {
    throw std::invalid_argument("write_image: the arrays do not fit the image's width and height");
  }
}

template <class Value>
std::byte* put(std::byte* at, Value value) {
  std::memcpy(at, &value, sizeof value);
  return at + sizeof value;
}

void add_channels(ImageDocument& document, const Image& image) {
  const bool depth = document.format == "exr" && !image.depth.empty();
  const bool patch = document.format == "exr" && !image.patch.empty();
  for (const char* name : {"R", "G", "B"}) document.channels.push_back({name, ChannelType::float32});
  if (depth) document.channels.push_back({"Z", ChannelType::float32});
  if (patch) document.channels.push_back({"patch", ChannelType::uint32});
  document.pixels.resize(4 * document.channels.size() * pixel_count(image));
  std::byte* at = document.pixels.data();
  for (std::size_t i = 0; i < pixel_count(image); ++i) {
    for (int k = 0; k < 3; ++k) at = put(at, image.rgb[3 * i + k]);
    if (depth) at = put(at, image.depth[i]);
    if (patch) at = put(at, static_cast<std::uint32_t>(image.patch[i]));
  }
  document.colour_space = "Linear";
}

void add_display_colours(ImageDocument& document, const Image& image, const ToneMap& tone_map) {
  for (const char* name : {"R", "G", "B"}) document.channels.push_back({name, ChannelType::uint8});
  document.pixels.resize(3 * pixel_count(image));
  std::byte* at = document.pixels.data();
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (const std::uint8_t value : tone_map(image.pixel(x, y))) at = put(at, value);
    }
  }
  document.colour_space = "sRGB";
}

}  // namespace

ToneMap tone_map_for(const Image& image) {
  std::vector<double> luminances;
  luminances.reserve(pixel_count(image));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) luminances.push_back(luminance(image.pixel(x, y)));
  }
  return tone_map_for(std::span<const double>(luminances));
}

void write_image(const std::filesystem::path& path, const Image& image, const ImageOptions& options) {
  require_whole(image);
  const std::string extension = output_extension(path, {".exr", ".hdr", ".png"});
  const auto encoder =
      *static_cast<const ImageEncoder*>(module_symbol("luxel_image", image_encoder_symbol, path));
  ImageDocument document;
  document.format = extension.substr(1);
  document.width = image.width;
  document.height = image.height;
  document.metadata = options.metadata;
  if (extension == ".png") {
    add_display_colours(document, image, options.tone_map.value_or(tone_map_for(image)));
  } else {
    add_channels(document, image);
  }
  OutputFile file(path);
  const EncodedImage encoded = encoder(document);
  if (!encoded.trouble.empty()) {
    throw InputError(path.string() + ": cannot be written: " + encoded.trouble);
  }
  file.write({reinterpret_cast<const char*>(encoded.bytes.data()), encoded.bytes.size()});
  file.commit();
}

}  // namespace luxel
