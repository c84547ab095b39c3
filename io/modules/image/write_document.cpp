#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <exception>

#include "output/image_document.h"

namespace luxel {

namespace {

OIIO::TypeDesc oiio_type(ChannelType type) {
  switch (type) {
    case ChannelType::uint8:
      return OIIO::TypeUInt8;
    case ChannelType::uint32:
      return OIIO::TypeUInt32;
    case ChannelType::float32:
      break;
  }
  return OIIO::TypeFloat;
}

OIIO::ImageSpec image_spec(const ImageDocument& document) {
  OIIO::ImageSpec spec(document.width, document.height, static_cast<int>(document.channels.size()),
                       oiio_type(document.channels.front().type));
  spec.channelnames.clear();
  for (const auto& [name, type] : document.channels) {
    spec.channelnames.push_back(name);
    spec.channelformats.push_back(oiio_type(type));
    if (name == "Z") spec.z_channel = static_cast<int>(spec.channelnames.size()) - 1;
  }
  spec.attribute("oiio:ColorSpace", document.colour_space);
  if (document.format == "exr") {
    spec.attribute("compression", "zip");
    // Rec. 709 primaries and white point D65: red, green, blue, white as x, y
    constexpr float chromaticities[] = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), chromaticities);
  }
  for (const auto& [name, value] : document.metadata) spec.attribute(name, value);
  return spec;
}

EncodedImage encode(const ImageDocument& document) try {
  // one thread encodes: a second pool of threads beside the caller's would cost more than it gives
  OIIO::attribute("threads", 1);
  OIIO::attribute("exr_threads", -1);
  auto output = OIIO::ImageOutput::create(document.format);
  if (!output) return {{}, OIIO::geterror()};
  EncodedImage result;
  OIIO::Filesystem::IOVecOutput memory(result.bytes);
  const bool written = output->set_ioproxy(&memory) &&
                       output->open("image." + document.format, image_spec(document)) &&
                       output->write_image(OIIO::TypeUnknown, document.pixels.data()) && output->close();
  if (!written) return {{}, output->geterror()};
  return result;
} catch (const std::exception& error) {
  return {{}, error.what()};
}

}  // namespace

}  // namespace luxel

extern "C" [[gnu::visibility("default")]] const luxel::ImageEncoder luxel_image_encoder_1 = luxel::encode;
