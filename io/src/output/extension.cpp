#include "extension.h"

#include <algorithm>

#include "luxel/input_error.h"

namespace luxel {

std::string output_extension(const std::filesystem::path& path, std::initializer_list<const char*> allowed) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (std::find(allowed.begin(), allowed.end(), extension) != allowed.end()) return extension;
  std::string message = path.string() + ": found extension '" + path.extension().string() + "', expected ";
  for (const char* name : allowed) message.append(name == *allowed.begin() ? "" : " or ").append(name);
  throw InputError(message);
}

}  // namespace luxel
