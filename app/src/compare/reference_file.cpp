#include "compare/reference_file.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>

#include "luxel/input_error.h"

namespace luxel::compare {

namespace {

// Fields of one line of CSV; quoted fields may hold commas and doubled quotes.
std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      fields.back() += line[i++];
    } else if (line[i] == '"') {
      quoted = !quoted;
    } else if (line[i] == ',' && !quoted) {
      fields.emplace_back();
    } else if (line[i] != '\r') {
      fields.back() += line[i];
    }
  }
  return fields;
}

}  // namespace

Reference read_reference(const std::string& file, int patches) {
  std::ifstream input(file);
  if (!input) throw InputError(fmt::format("{}: cannot be read, expected a CSV of patches", file));
  std::string line;
  std::getline(input, line);
  const std::vector<std::string> header = fields_of(line);
  std::size_t columns[3];
  for (int channel = 0; channel < 3; ++channel) {
    const std::string wanted = fmt::format("B_{}", "rgb"[channel]);
    columns[channel] = std::find(header.begin(), header.end(), wanted) - header.begin();
    if (columns[channel] == header.size()) throw InputError(fmt::format("{}:1: no column {}", file, wanted));
  }
  Reference reference{"file", std::nan(""), PatchField::Zero(patches, 3)};
  int row = 0;
  for (; std::getline(input, line); ++row) {
    const std::vector<std::string> fields = fields_of(line);
    if (row == patches) break;
    for (int channel = 0; channel < 3; ++channel) {
      const std::string text = columns[channel] < fields.size() ? fields[columns[channel]] : "";
      double& value = reference.radiosity(row, channel);
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
        throw InputError(fmt::format("{}:{}: {}: found '{}', expected a number", file, row + 2,
                                     header[columns[channel]], text));
      }
    }
  }
  if (row != patches || std::getline(input, line)) {
    throw InputError(fmt::format("{}: another number of patches than the scene's {}", file, patches));
  }
  return reference;
}

}  // namespace luxel::compare
