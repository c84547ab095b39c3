#include "repeated_loops.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace luxel {

namespace {

/// The loop turned so that its smallest corner comes first, and reversed if that makes the second one
/// smaller.
bool make_canonical(std::span<int> loop) {
  if (loop.size() < 3) return false;
  std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
  if (loop[1] < loop.back()) return false;
  std::reverse(loop.begin() + 1, loop.end());
  return true;
}

}  // namespace

RepeatedLoops find_repeated(const Loops& loops) {
  Loops canonical = loops;
  RepeatedLoops result;
  std::vector<std::uint64_t> hashes;
  for (int i = 0; i < loops.size(); ++i) {
    const auto loop = std::span(canonical.entries)
                          .subspan(canonical.offsets[i], canonical.offsets[i + 1] - canonical.offsets[i]);
    result.reversed.push_back(make_canonical(loop));
    std::uint64_t hash = loop.size();
    for (const int v : loop) {
      hash = (hash ^ static_cast<std::uint64_t>(v)) * 0xff51afd7ed558ccdull;
      hash ^= hash >> 29;
    }
    hashes.push_back(hash);
  }
  std::vector<int> order(loops.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return hashes[a] != hashes[b] ? hashes[a] < hashes[b] : a < b; });

  result.first.resize(loops.size());
  std::iota(result.first.begin(), result.first.end(), 0);
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    while (end < order.size() && hashes[order[end]] == hashes[order[begin]]) ++end;
    for (std::size_t k = begin + 1; k < end; ++k) {
      for (std::size_t m = begin; m < k; ++m) {
        if (result.first[order[m]] != order[m]) continue;
        if (std::ranges::equal(canonical[order[k]], canonical[order[m]])) {
          result.first[order[k]] = order[m];
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
