#pragma once

#include <filesystem>
#include <string_view>

namespace luxel {

/// A file that appears whole or not at all: bytes go to a temporary beside it, which takes the file's name on
/// commit() and is removed if that never comes. Until then a file that already has the name stays as it is.
/// A symbolic link keeps pointing where it points; a device or a pipe (/dev/stdout) is written directly.
/// What it does not promise: that a temporary is removed when the process is killed (it is named
/// `.<name>.<process>-<number>.part`).
class OutputFile {
 public:
  /// Makes the temporary, so that a place that cannot be written to is known before the work is done.
  /// @throws InputError naming the file and the reason
  explicit OutputFile(std::filesystem::path path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Appends bytes.
  /// @throws InputError, for example where the disk is full
  void write(std::string_view bytes);

  /// The file to write to, for a library that opens files by name. What it writes replaces what write()
  /// wrote.
  const std::filesystem::path& working_path() const { return working_; }

  /// Brings the bytes to the disk (fsync) and gives the file its name. Nothing can be written afterwards.
  /// @throws InputError; the file then is as it was before
  void commit();

 private:
  [[noreturn]] void fail(int error) const;

  std::filesystem::path path_;     ///< as the user named it
  std::filesystem::path target_;   ///< with links followed
  std::filesystem::path working_;  ///< the temporary, or the device itself
  int descriptor_ = -1;
  bool direct_ = false;
};

/// Writes a whole file at once, as OutputFile does.
/// @throws InputError naming the file and the reason
void write_file(const std::filesystem::path& path, std::string_view content);

}  // namespace luxel
