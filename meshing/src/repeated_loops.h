#pragma once

#include <span>
#include <vector>

namespace luxel {

/// Loops of vertex indices: loop i has the entries [offsets[i], offsets[i + 1]) of `entries`.
struct Loops {
  std::vector<int> offsets{0};
  std::vector<int> entries;

  int size() const { return static_cast<int>(offsets.size()) - 1; }
  std::span<const int> operator[](int i) const {
    return std::span(entries).subspan(offsets[i], offsets[i + 1] - offsets[i]);
  }
  void append(std::span<const int> loop) {
    entries.insert(entries.end(), loop.begin(), loop.end());
    offsets.push_back(static_cast<int>(entries.size()));
  }
};

/// Where each loop stands among those with the same corners in the same cyclic order, whatever the direction.
struct RepeatedLoops {
  std::vector<int> first;      ///< the first loop with the same corners; the loop itself if it is the first
  std::vector<char> reversed;  ///< whether it runs against that first one
};

/// Cost: n log n.
RepeatedLoops find_repeated(const Loops& loops);

}  // namespace luxel
