#include "output_files.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "luxel/input_error.h"
#include "suggestion.h"

namespace luxel::app {

namespace fs = std::filesystem;

std::string extension_of(const std::string& file) {
  std::string extension = fs::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

void check_output(const std::string& file, const std::string& input) {
  std::error_code error;
  const fs::path folder = fs::path(file).has_parent_path() ? fs::path(file).parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error)) {
    throw InputError(fmt::format("{}: the folder '{}' does not exist", file, folder.string()));
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    throw InputError(fmt::format("{}: the folder '{}' cannot be written to", file, folder.string()));
  }
  if (fs::is_directory(file, error)) {
    throw InputError(fmt::format("{}: found a folder, expected the name of a file to write", file));
  }
  if (fs::exists(file, error) && fs::equivalent(file, input, error)) {
    throw InputError(fmt::format("{}: this is the scene itself, expected another file to write", file));
  }
}

void check_outputs(std::span<const std::string> files, std::span<const std::string> extensions,
                   const std::string& input) {
  std::set<fs::path> seen;
  for (const std::string& file : files) {
    const std::string extension = extension_of(file);
    if (std::find(extensions.begin(), extensions.end(), extension) == extensions.end()) {
      throw InputError(fmt::format("{}: cannot write the extension '{}', expected one of {}{}", file,
                                   extension, fmt::join(extensions, " "), suggestion(extension, extensions)));
    }
    check_output(file, input);
    std::error_code error;
    if (!seen.insert(fs::weakly_canonical(file, error)).second) {
      throw InputError(fmt::format("{}: asked for twice, expected each output once", file));
    }
  }
}

}  // namespace luxel::app
