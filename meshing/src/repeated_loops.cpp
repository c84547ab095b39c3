#include "repeated_loops.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace luxel {

namespace {

/// Puts the loop turned so that its smallest corner comes first, and reversed if that makes the second one
/// smaller, into `canonical`. Gives whether it was reversed.
bool make_canonical(std::span<const int> loop, std::vector<int>& canonical) {
  if (loop.size() < 3) {
    canonical.assign(loop.begin(), loop.end());
    return false;
  }
  const auto smallest = std::min_element(loop.begin(), loop.end());
  canonical.assign(smallest, loop.end());
  canonical.insert(canonical.end(), loop.begin(), smallest);
  if (canonical[1] < canonical.back()) return false;
  std::reverse(canonical.begin() + 1, canonical.end());
  return true;
}

std::uint64_t hash_of(std::span<const int> loop) {
  std::uint64_t hash = loop.size();
  for (const int v : loop) {
    hash = (hash ^ static_cast<std::uint64_t>(v)) * 0xff51afd7ed558ccdull;
    hash ^= hash >> 29;
  }
  return hash;
}

}  // namespace

RepeatedLoops find_repeated(const Loops& loops) {
  RepeatedLoops result;
  result.first.resize(loops.size());
  std::iota(result.first.begin(), result.first.end(), 0);
  result.reversed.reserve(loops.size());
  std::vector<std::uint64_t> hashes;
  hashes.reserve(loops.size());
  std::vector<int> canonical, other;
  // Equal loops start with the same corner once they are canonical: loops by that one.
  const int corners = loops.entries.empty() ? 0 : *std::ranges::max_element(loops.entries) + 1;
  std::vector<int> start;  // `corners` for a loop without any
  start.reserve(loops.size());
  std::vector<int> begin(corners + 2, 0);
  for (int i = 0; i < loops.size(); ++i) {
    result.reversed.push_back(make_canonical(loops[i], canonical));
    hashes.push_back(hash_of(canonical));
    start.push_back(canonical.empty() ? corners : canonical.front());
    ++begin[start.back() + 1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<int> order(loops.size());
  for (int i = 0; i < loops.size(); ++i) order[begin[start[i]]++] = i;  // begin: now the end of each bucket

  for (std::size_t from = 0, to = 0; from < order.size(); from = to) {
    to = static_cast<std::size_t>(begin[start[order[from]]]);
    if (to - from == 1) continue;
    std::sort(order.begin() + static_cast<std::ptrdiff_t>(from),
              order.begin() + static_cast<std::ptrdiff_t>(to),
              [&](int a, int b) { return hashes[a] != hashes[b] ? hashes[a] < hashes[b] : a < b; });
    std::size_t like = from;  // the first with the hash of the k-th
    for (std::size_t k = from + 1; k < to; ++k) {
      const int loop = order[k];
      if (hashes[order[like]] != hashes[loop]) {
        like = k;
        continue;
      }
      make_canonical(loops[loop], canonical);
      for (std::size_t m = like; m < k; ++m) {
        if (result.first[order[m]] != order[m]) continue;
        make_canonical(loops[order[m]], other);
        if (canonical == other) {
          result.first[loop] = order[m];
          break;
        }
      }
    }
  }
  const std::vector<char> turned = result.reversed;
  for (int i = 0; i < loops.size(); ++i) result.reversed[i] = turned[i] != turned[result.first[i]];
  return result;
}

}  // namespace luxel
