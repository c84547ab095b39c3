#include "luxel/write_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <tuple>
#include <utility>

#include "luxel/input_error.h"

namespace luxel {

namespace fs = std::filesystem;

namespace {

// The target with links followed; of a link that dangles, the path that it names
fs::path follow_links(const fs::path& path) {
  fs::path target = path;
  // as many links as Linux itself follows before it gives up
  constexpr int most_links = 40;
  std::error_code error;
  for (int i = 0; i < most_links && fs::is_symlink(target, error); ++i) {
    const fs::path next = fs::read_symlink(target, error);
    if (error) break;
    target = next.is_absolute() ? next : target.parent_path() / next;
  }
  return target;
}

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

int open_file(const fs::path& path, int flags, mode_t mode = 0) {
  int descriptor;
  do {
    descriptor = open(path.c_str(), flags | O_CLOEXEC, mode);
  } while (descriptor < 0 && errno == EINTR);
  return descriptor;
}

}  // namespace

OutputFile::OutputFile(fs::path path) : path_(std::move(path)), target_(follow_links(path_)) {
  struct stat status {};
  const bool exists = stat(target_.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) fail(EISDIR);
  if (!target_.has_filename()) fail(ENOENT);
  direct_ = exists && !S_ISREG(status.st_mode);
  if (direct_) {
    working_ = target_;
    descriptor_ = open_file(working_, O_WRONLY);
  } else {
    if (exists && access(target_.c_str(), W_OK) != 0) fail(errno);
    // a temporary that a killed process left behind keeps its name
    const std::string stem = target_.filename().string() + "." + std::to_string(getpid()) + "-";
    for (int number = 0; descriptor_ < 0; ++number) {
      working_ = folder_of(target_) / ".";
      working_ += stem + std::to_string(number) + ".part";
      descriptor_ = open_file(working_, O_WRONLY | O_CREAT | O_EXCL, 0666);
      if (descriptor_ < 0 && errno != EEXIST) fail(errno);
    }
    // a file that is replaced keeps its mode where the system lets us
    if (exists) std::ignore = fchmod(descriptor_, status.st_mode & 07777);
  }
  if (descriptor_ < 0) fail(errno);
}

OutputFile::~OutputFile() {
  if (descriptor_ < 0) return;
  close(descriptor_);
  if (!direct_) unlink(working_.c_str());
}

void OutputFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void OutputFile::commit() {
  // fsync refuses devices and pipes with EINVAL: there is nothing to bring to a disk
  if (fsync(descriptor_) != 0 && !direct_) fail(errno);
  if (direct_) {
    if (close(std::exchange(descriptor_, -1)) != 0) fail(errno);
    return;
  }
  if (rename(working_.c_str(), target_.c_str()) != 0) fail(errno);
  close(std::exchange(descriptor_, -1));
  // the new name reaches the disk with its folder; a file system that cannot do so is no reason to fail
  if (const int folder = open_file(folder_of(target_), O_RDONLY | O_DIRECTORY); folder >= 0) {
    fsync(folder);
    close(folder);
  }
}

void OutputFile::fail(int error) const {
  std::string reason = std::generic_category().message(error);
  std::error_code ignored;
  const fs::path folder = folder_of(target_);
  if (error == ENOENT && !fs::exists(folder, ignored))
    reason = "the folder '" + folder.string() + "' does not exist";
  if (error == EISDIR) reason = "it is a folder";
  if (error == ENOTDIR) reason = "'" + folder.string() + "' is not a folder";
  throw InputError(path_.string() + ": cannot be written: " + reason);
}

void write_file(const fs::path& path, std::string_view content) {
  OutputFile file(path);
  file.write(content);
  file.commit();
}

}  // namespace luxel
