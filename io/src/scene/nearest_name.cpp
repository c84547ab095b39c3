#include "luxel/nearest_name.h"

#include <algorithm>
#include <cctype>
#include <limits>
#include <vector>

namespace luxel {
namespace {

// Costs are counted in halves of a keystroke, so that they stay whole numbers.
constexpr int keystroke = 2;
constexpr int case_slip = 1;

char small(char letter) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
}

int replace_cost(char a, char b) {
  if (a == b) return 0;
  return small(a) == small(b) ? case_slip : keystroke;
}

// Optimal string alignment: Damerau 1964, Levenshtein 1966, with three rows of the table of prefixes.
int distance(std::string_view a, std::string_view b) {
  std::vector<int> before(b.size() + 1), previous(b.size() + 1), current(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) previous[j] = static_cast<int>(j) * keystroke;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    current[0] = static_cast<int>(i) * keystroke;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      current[j] = std::min({previous[j] + keystroke, current[j - 1] + keystroke,
                             previous[j - 1] + replace_cost(a[i - 1], b[j - 1])});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) current[j] = std::min(current[j], before[j - 2] + keystroke);
    }
    std::swap(before, previous);
    std::swap(previous, current);
  }
  return previous[b.size()];
}

}  // namespace

std::optional<std::string> nearest_name(std::string_view name, std::span<const std::string> candidates) {
  std::optional<std::string> nearest;
  int least = std::numeric_limits<int>::max();
  for (const std::string& candidate : candidates) {
    const int d = distance(name, candidate);
    if (d < least) {
      least = d;
      nearest = candidate;
    }
  }
  return nearest;
}

}  // namespace luxel
