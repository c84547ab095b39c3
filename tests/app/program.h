#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace luxel::test {

/// How a run of the program ended.
struct Outcome {
  int status = -1;  ///< exit status; 128 + n where signal n ended it
  std::string out;  ///< stdout
  std::string err;  ///< stderr
};

/// Runs the luxel that was built with the tests, without a shell. With `interrupt_after` >= 0, SIGINT is sent
/// to it after so many milliseconds.
Outcome luxel(const std::vector<std::string>& arguments, int interrupt_after = -1);

/// The same for any program.
Outcome run_program(const std::string& program, const std::vector<std::string>& arguments,
                    int interrupt_after = -1);

/// A folder of its own for each test, gone when the test ends.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  /// Writes a file and gives its path.
  std::string write(const std::string& name, const std::string& content) const;
  std::string read(const std::string& name) const;
  std::vector<std::string> files() const;  ///< names, sorted, those that begin with a dot too

 private:
  std::filesystem::path folder_;
};

/// A run of `luxel solve`: its JSON report and its patches with 17 digits, both empty where it was refused.
struct Solved {
  Outcome outcome;
  nlohmann::json report;
  std::string csv;
};

Solved solve(const std::string& scene_text, const std::vector<std::string>& options);

/// Path of one of the meshes in tests/data/obj.
std::string mesh(const std::string& name);

/// A scene file for a mesh of tests/data/obj: {"mesh": ..., "materials": ..., "surfaces": ...}.
std::string scene_text(const std::string& mesh_name, const nlohmann::json& materials,
                       const nlohmann::json& surfaces = nlohmann::json::object());

/// One column of a CSV file of patches, for example "B_r".
std::vector<double> csv_column(const std::string& csv, const std::string& name);

int line_count(const std::string& text);

}  // namespace luxel::test
