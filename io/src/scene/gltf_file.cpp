// tinygltf is a header; this is the source file that holds it.
#define TINYGLTF_IMPLEMENTATION
#include "scene/gltf_file.h"

#include <algorithm>

#include "scene/file_text.h"
#include "scene/input_location.h"

namespace luxel {
namespace {

bool ignore_image(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int,
                  void*) {
  return true;
}

}  // namespace

tinygltf::Model gltf_model(const std::filesystem::path& file) {
  const std::string bytes = file_bytes(file);
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(ignore_image, nullptr);
  tinygltf::Model model;
  std::string error, warning;
  const std::string folder = file.parent_path().string();
  bool loaded = false;
  try {
    const auto size = static_cast<unsigned int>(bytes.size());
    loaded =
        bytes.starts_with("glTF")
            ? loader.LoadBinaryFromMemory(&model, &error, &warning,
                                          reinterpret_cast<const unsigned char*>(bytes.data()), size, folder)
            : loader.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, folder);
  } catch (const std::exception& failure) {
    error = failure.what();
  }
  while (!error.empty() && error.back() == '\n') error.pop_back();
  if (!loaded) refuse({file}, "not glTF 2.0: " + (error.empty() ? "no reason given" : error));
  return model;
}

}  // namespace luxel
