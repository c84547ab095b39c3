#pragma once

#include <filesystem>
#include <string>

namespace luxel {

/// The bytes of a file, whole.
/// @throws InputError if it does not exist, is a directory, may not be read or is empty.
std::string file_bytes(const std::filesystem::path& file);

/// The text of a file without byte order mark; lines end in '\n' or "\r\n".
/// @throws InputError as file_bytes(), and if the file holds zero bytes, which no text does.
std::string file_text(const std::filesystem::path& file);

}  // namespace luxel
