#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>

namespace luxel {

/// The extension of an output file with its dot, in lower case.
/// @throws InputError if it is none of `allowed`, which are listed in the message
std::string output_extension(const std::filesystem::path& path, std::initializer_list<const char*> allowed);

}  // namespace luxel
