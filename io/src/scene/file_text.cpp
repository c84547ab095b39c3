#include "scene/file_text.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "scene/input_location.h"

namespace luxel {

std::string file_bytes(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found) refuse({file}, "no such file");
  if (error) refuse({file}, "cannot be read: " + error.message());
  if (std::filesystem::is_directory(status)) refuse({file}, "is a directory; expected a file");

  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) refuse({file}, std::string("cannot be read: ") + std::strerror(errno));
  std::string bytes;
  if (std::filesystem::is_regular_file(status)) {
    bytes.resize(std::filesystem::file_size(file));
    stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(stream.gcount()));
  } else {
    // A pipe has no size.
    bytes.assign(std::istreambuf_iterator<char>(stream), {});
  }
  if (stream.bad()) refuse({file}, "cannot be read: " + std::string(std::strerror(errno)));
  if (bytes.empty()) refuse({file}, "is empty");
  return bytes;
}

std::string file_text(const std::filesystem::path& file) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  std::string text = file_bytes(file);
  if (text.starts_with(byte_order_mark)) text.erase(0, byte_order_mark.size());
  const std::size_t zero = text.find('\0');
  if (zero != std::string::npos) {
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(zero), '\n');
    refuse({file, static_cast<int>(line)}, "a zero byte; expected a text file");
  }
  // Line ends of old Macintosh programs.
  if (text.find('\n') == std::string::npos) std::replace(text.begin(), text.end(), '\r', '\n');
  return text;
}

}  // namespace luxel
