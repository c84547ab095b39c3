// The code in the README is the code of examples/road.cpp, which compiles and runs.
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "app/program.h"

namespace luxel::test {
namespace {

const std::filesystem::path root = std::filesystem::path(LUXEL_TEST_DATA).parent_path().parent_path();

std::string content(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const auto from = text.find(begin);
  if (from == std::string::npos) return "";
  const auto start = from + begin.size();
  return text.substr(start, text.find(end, start) - start);
}

// Two spaces fewer at the start of each line.
std::string outdented(const std::string& text) {
  std::istringstream lines(text);
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    result += (line.rfind("  ", 0) == 0 ? line.substr(2) : line) + "\n";
  }
  return result;
}

TEST(Readme, ShowsTheRoadAsItIsCompiled) {
  const std::string shown = between(content(root / "README.md"), "```cpp\n", "```");
  const std::string compiled = between(content(root / "examples" / "road.cpp"), "// [road]\n", "  // [road]");

  EXPECT_FALSE(shown.empty());
  EXPECT_EQ(shown, outdented(compiled));
}

TEST(Readme, NamesTheTwoCommandsOnLinesOfTheirOwn) {
  const std::string readme = content(root / "README.md");

  EXPECT_NE(readme.find("\n    ./tests/run\n"), std::string::npos);
  EXPECT_NE(readme.find("\n    ./examples/run\n"), std::string::npos);
}

TEST(Road, LightsACube) {
  const Folder folder;
  const std::string scene =
      folder.write("scene.json", scene_text("cube", {{"white", {{"reflectance", 0.5}, {"exitance", 1}}}}));
  const std::string program = std::filesystem::path(LUXEL_PROGRAM).parent_path() / "road";

  const Outcome outcome = run_program(program, {scene, folder.path("a.csv")});

  EXPECT_EQ(outcome.status, 0) << outcome.err;
  // white furnace E / (1 - rho) = 2; solved to the default tolerance of 1e-6
  for (const double b : csv_column(folder.read("a.csv"), "B_r")) EXPECT_NEAR(b, 2, 1e-5);
}

}  // namespace
}  // namespace luxel::test
