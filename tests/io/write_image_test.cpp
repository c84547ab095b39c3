#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>

#include "io/scratch.h"
#include "luxel/image.h"
#include "luxel/input_error.h"
#include "luxel/write_file.h"

namespace luxel {
namespace {

using testing::content;
using testing::Scratch;

// 2 x 2 pixels: a grey ramp, a saturated red, and nothing
Image sample() {
  Image image;
  image.width = 2;
  image.height = 2;
  image.rgb = {0.25f, 0.25f, 0.25f, 0.5f, 0.5f, 0.5f, 8, 0.125f, 0, 0, 0, 0};
  image.depth = {1, 2, 3, std::numeric_limits<float>::infinity()};
  image.patch = {0, 7, 16'777'217, Image::nothing};  // 2^24 + 1 does not fit into float32
  return image;
}

// What OpenImageIO's own tool prints of the file's pixels
std::string pixels(const std::filesystem::path& path) {
  return testing::output_of("oiiotool --dumpdata " + path.string());
}

TEST(WriteImage, ExrHoldsRadianceDepthAndPatchByName) {
  const Scratch scratch;

  write_image(scratch / "a.exr", sample(), {.metadata = {{"luxel:scene", "room.obj"}}});

  const std::string info = testing::output_of("oiiotool -v --info " + (scratch / "a.exr").string());
  EXPECT_NE(info.find("R (float), G (float), B (float), Z (float), patch (uint)"), std::string::npos) << info;
  EXPECT_NE(info.find("chromaticities: 0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329"), std::string::npos)
      << info;
  EXPECT_NE(info.find("luxel:scene: \"room.obj\""), std::string::npos) << info;
  const std::string text = pixels(scratch / "a.exr");
  EXPECT_NE(text.find("Pixel (0, 0): 0.250000000 0.250000000 0.250000000 1.000000000"), std::string::npos)
      << text;
  EXPECT_NE(text.find("Pixel (0, 1): 8.000000000 0.125000000 0.000000000 3.000000000"), std::string::npos)
      << text;
  EXPECT_NE(text.find("inf"), std::string::npos) << text;
  EXPECT_EQ(scratch.entries(), 1);
}

TEST(WriteImage, HdrHoldsRadianceToOnePerCent) {
  const Scratch scratch;

  write_image(scratch / "a.hdr", sample());

  const std::string bytes = content(scratch / "a.hdr");
  EXPECT_EQ(bytes.rfind("#?RADIANCE\n", 0), 0u);
  const std::string text = pixels(scratch / "a.hdr");
  float r = 0, g = 0, b = 0;
  const auto at = text.find("Pixel (0, 1):");
  ASSERT_NE(at, std::string::npos) << text;
  ASSERT_EQ(std::sscanf(text.c_str() + at, "Pixel (0, 1): %f %f %f", &r, &g, &b), 3) << text;
  EXPECT_NEAR(r, 8, 0.08);
  EXPECT_NEAR(g, 0.125, 0.08);  // the exponent is the brightest channel's
}

TEST(WriteImage, PngHoldsWhatTheToneMapGives) {
  const Scratch scratch;
  const ToneMap tone_map{.exposure = 1};

  write_image(scratch / "a.png", sample(), {.tone_map = tone_map});

  const std::string text = pixels(scratch / "a.png");
  // sRGB of 0.25 is 0.5371 (IEC 61966-2-1), 137 of 255; of 0.5 it is 0.7354, 188
  EXPECT_NE(text.find("Pixel (0, 0): 137 137 137"), std::string::npos) << text;
  EXPECT_NE(text.find("Pixel (1, 0): 188 188 188"), std::string::npos) << text;
  EXPECT_NE(text.find("Pixel (1, 1): 0 0 0"), std::string::npos) << text;
}

TEST(WriteImage, TheSameImageGivesTheSameBytes) {
  const Scratch scratch;
  for (const char* extension : {".exr", ".png", ".hdr"}) {
    const std::string first = std::string("a") + extension, second = std::string("b") + extension;

    write_image(scratch / first, sample());
    write_image(scratch / second, sample());

    EXPECT_EQ(content(scratch / first), content(scratch / second)) << extension;
  }
}

TEST(WriteImage, AFileThatGrowsBeyondTheLimitLeavesTheOldOne) {
  const Scratch scratch;
  rlimit limit{}, small{};
  getrlimit(RLIMIT_FSIZE, &limit);
  small = limit;
  small.rlim_cur = 40;
  for (const char* name : {"a.exr", "a.png", "a.hdr"}) write_file(scratch / name, "old");
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);

  for (const char* name : {"a.exr", "a.png", "a.hdr"}) {
    EXPECT_THROW(write_image(scratch / name, sample()), InputError) << name;
  }

  setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, old_handler);
  for (const char* name : {"a.exr", "a.png", "a.hdr"}) EXPECT_EQ(content(scratch / name), "old");
  EXPECT_EQ(scratch.entries(), 3);
}

TEST(WriteImage, ReadsExtensionsInCapitals) {
  const Scratch scratch;

  write_image(scratch / "A.PNG", sample());

  EXPECT_EQ(content(scratch / "A.PNG").substr(1, 3), "PNG");
}

TEST(WriteImage, RefusesOtherExtensionsAndShapes) {
  const Scratch scratch;
  Image image = sample();

  try {
    write_image(scratch / "a.jpg", image);
    ADD_FAILURE() << "a.jpg was written";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(),
              (scratch / "a.jpg").string() + ": found extension '.jpg', expected .exr or .hdr or .png");
  }
  image.rgb.pop_back();
  EXPECT_THROW(write_image(scratch / "a.exr", image), std::invalid_argument);
  EXPECT_EQ(scratch.entries(), 0);
}

}  // namespace
}  // namespace luxel
