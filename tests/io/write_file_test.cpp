#include "luxel/write_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <fstream>

#include "io/scratch.h"
#include "luxel/input_error.h"

namespace luxel {
namespace {

using testing::content;
using testing::Scratch;

// What went wrong when writing to `path`, or "" if nothing did
std::string trouble(const std::filesystem::path& path, const std::string& text = "text") {
  try {
    write_file(path, text);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(WriteFile, WritesWhatItIsGiven) {
  const Scratch scratch;
  const std::string bytes("a\0b\n", 4);

  write_file(scratch / "a.bin", bytes);

  EXPECT_EQ(content(scratch / "a.bin"), bytes);
  EXPECT_EQ(scratch.entries(), 1);
}

TEST(WriteFile, ReplacesAFileAndKeepsItsMode) {
  const Scratch scratch;
  write_file(scratch / "a", "old");
  chmod((scratch / "a").c_str(), 0640);

  write_file(scratch / "a", "new");

  struct stat status {};
  stat((scratch / "a").c_str(), &status);
  EXPECT_EQ(content(scratch / "a"), "new");
  EXPECT_EQ(status.st_mode & 0777, 0640u);
}

TEST(WriteFile, ASymbolicLinkKeepsPointingWhereItPoints) {
  const Scratch scratch;
  write_file(scratch / "real", "old");
  std::filesystem::create_symlink("real", scratch / "link");

  write_file(scratch / "link", "new");

  EXPECT_TRUE(std::filesystem::is_symlink(scratch / "link"));
  EXPECT_EQ(content(scratch / "real"), "new");
}

TEST(WriteFile, NothingAppearsWithoutCommit) {
  const Scratch scratch;
  write_file(scratch / "a", "old");

  {
    OutputFile file(scratch / "a");
    file.write("half of the new");
    EXPECT_EQ(content(scratch / "a"), "old");
  }

  EXPECT_EQ(content(scratch / "a"), "old");
  EXPECT_EQ(scratch.entries(), 1);
}

TEST(WriteFile, TwoWritersOfOneFileDoNotMix) {
  const Scratch scratch;
  OutputFile first(scratch / "a"), second(scratch / "a");

  first.write("first");
  second.write("second");
  second.commit();
  first.commit();

  EXPECT_EQ(content(scratch / "a"), "first");
  EXPECT_EQ(scratch.entries(), 1);
}

TEST(WriteFile, SaysThatTheFolderIsMissing) {
  const Scratch scratch;
  const auto path = scratch / "no/a.csv";

  EXPECT_EQ(trouble(path), path.string() + ": cannot be written: the folder '" + (scratch / "no").string() +
                               "' does not exist");
}

TEST(WriteFile, SaysThatTheParentIsAFile) {
  const Scratch scratch;
  write_file(scratch / "file", "");

  EXPECT_NE(trouble(scratch / "file/a.csv").find("is not a folder"), std::string::npos);
}

TEST(WriteFile, SaysThatTheFileIsAFolder) {
  const Scratch scratch;

  EXPECT_NE(trouble(scratch.folder()).find("it is a folder"), std::string::npos);
  EXPECT_NE(trouble(scratch.folder() / "").find("it is a folder"), std::string::npos);
  EXPECT_EQ(scratch.entries(), 0);
}

TEST(WriteFile, SaysThatADeviceIsFull) {
  EXPECT_NE(trouble("/dev/full").find("/dev/full: cannot be written: No space left"), std::string::npos);
}

TEST(WriteFile, WritesToADeviceWithoutReplacingIt) {
  EXPECT_EQ(trouble("/dev/null"), "");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(WriteFile, AFileThatGrowsBeyondTheLimitLeavesTheOldOne) {
  const Scratch scratch;
  write_file(scratch / "a", "old");
  rlimit limit{}, small{};
  getrlimit(RLIMIT_FSIZE, &limit);
  small = limit;
  small.rlim_cur = 1000;
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);

  const std::string message = trouble(scratch / "a", std::string(5000, 'x'));

  setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_NE(message.find("File too large"), std::string::npos) << message;
  EXPECT_EQ(content(scratch / "a"), "old");
  EXPECT_EQ(scratch.entries(), 1);
}

}  // namespace
}  // namespace luxel
