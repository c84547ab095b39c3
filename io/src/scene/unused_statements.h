#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace luxel {

/// Counts what a file says and Luxel does not use, so that nothing is dropped in silence.
class UnusedStatements {
 public:
  void count(std::string_view statement);

  /// "room.mtl: not used: map_Kd (2 times), Ks (1 time)", once; nothing where everything was used.
  void warn(const std::filesystem::path& file, std::vector<std::string>& warnings) const;

 private:
  struct Entry {
    std::string statement;
    std::size_t times = 0;
  };
  std::vector<Entry> entries_;
  std::size_t others_ = 0;
};

}  // namespace luxel
