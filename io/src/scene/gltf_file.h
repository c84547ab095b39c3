#pragma once

#include <filesystem>

#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>

namespace luxel {

/// The file as tinygltf has it, images left out. @throws InputError if it cannot be read.
tinygltf::Model gltf_model(const std::filesystem::path& file);

}  // namespace luxel
