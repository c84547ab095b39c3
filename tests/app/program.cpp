#include "app/program.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace luxel::test {

namespace fs = std::filesystem;

namespace {

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> parts;
  std::istringstream stream(line);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

}  // namespace

Outcome luxel(const std::vector<std::string>& arguments, int interrupt_after) {
  return run_program(LUXEL_PROGRAM, arguments, interrupt_after);
}

Outcome run_program(const std::string& program, const std::vector<std::string>& arguments,
                    int interrupt_after) {
  const Folder streams;
  const std::string out = streams.path("out"), err = streams.path("err");
  std::vector<char*> argv = {const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);

  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) {
    dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
    dup2(open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
    dup2(open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
    execv(argv[0], argv.data());
    _exit(127);
  }
  if (interrupt_after >= 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(interrupt_after));
    kill(child, SIGINT);
  }
  int state = 0;
  waitpid(child, &state, 0);
  return {WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state), content(out), content(err)};
}

Folder::Folder() {
  std::string name = (fs::temp_directory_path() / "luxel-test-XXXXXX").string();
  if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
  folder_ = name;
}

Folder::~Folder() {
  std::error_code error;
  fs::remove_all(folder_, error);
}

std::string Folder::write(const std::string& name, const std::string& text) const {
  std::ofstream(folder_ / name, std::ios::binary) << text;
  return path(name);
}

std::string Folder::read(const std::string& name) const {
  return content(folder_ / name);
}

std::vector<std::string> Folder::files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

Solved solve(const std::string& scene_text, const std::vector<std::string>& options) {
  const Folder folder;
  std::vector<std::string> arguments = {
      "solve",           folder.write("scene.json", scene_text), "--json", "-o", folder.path("out.csv"),
      "--full-precision"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  Solved solved;
  solved.outcome = luxel(arguments);
  if (solved.outcome.status <= 1) {
    solved.report = nlohmann::json::parse(solved.outcome.out);
    solved.csv = folder.read("out.csv");
  }
  return solved;
}

std::string mesh(const std::string& name) {
  return std::string(LUXEL_TEST_DATA) + "/obj/" + name + ".obj";
}

std::string scene_text(const std::string& mesh_name, const nlohmann::json& materials,
                       const nlohmann::json& surfaces) {
  nlohmann::json scene = {{"mesh", mesh(mesh_name)}};
  if (!materials.empty()) scene["materials"] = materials;
  if (!surfaces.empty()) scene["surfaces"] = surfaces;
  return scene.dump(2);
}

std::vector<double> csv_column(const std::string& csv, const std::string& name) {
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  const auto header = fields(line);
  const auto column = std::find(header.begin(), header.end(), name) - header.begin();
  std::vector<double> values;
  while (std::getline(lines, line)) values.push_back(std::stod(fields(line).at(column)));
  return values;
}

int line_count(const std::string& text) {
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace luxel::test
