#include "scene/unused_statements.h"

#include "scene/input_location.h"

namespace luxel {
namespace {

// A file of another kind may hold any number of unknown words; past this many they are counted together.
constexpr std::size_t most_named = 20;

}  // namespace

void UnusedStatements::count(std::string_view statement) {
  for (Entry& entry : entries_) {
    if (entry.statement == statement) {
      ++entry.times;
      return;
    }
  }
  if (entries_.size() < most_named) {
    entries_.push_back({std::string(statement), 1});
  } else {
    ++others_;
  }
}

void UnusedStatements::warn(const std::filesystem::path& file, std::vector<std::string>& warnings) const {
  if (entries_.empty()) return;
  std::string sentence = file.string() + ": not used:";
  for (const Entry& entry : entries_) {
    sentence += (&entry == entries_.data() ? " " : ", ") + entry.statement + " (" +
                counted(entry.times, "time") + ")";
  }
  if (others_ > 0) sentence += " and " + counted(others_, "other statement");
  warnings.push_back(sentence);
}

}  // namespace luxel
