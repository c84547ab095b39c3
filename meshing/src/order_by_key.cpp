#include "order_by_key.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace luxel {

namespace {

// Bits of a key that one pass sorts by: the counts of 2^11 values fit in the first cache.
constexpr int digit_bits = 11;
constexpr std::size_t digit_values = std::size_t{1} << digit_bits;

// Below this many keys a comparison sort is faster than counting.
constexpr std::size_t few = 512;

}  // namespace

std::vector<int> order_by_key(const std::vector<std::uint64_t>& keys) {
  std::vector<int> order(keys.size());
  std::iota(order.begin(), order.end(), 0);
  if (keys.size() < few) {
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return keys[a] < keys[b]; });
    return order;
  }
  std::uint64_t differing = 0;
  for (const std::uint64_t key : keys) differing |= key ^ keys.front();

  struct Item {
    std::uint64_t key;
    int place;
  };
  std::vector<Item> items, sorted(keys.size());
  items.reserve(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) items.push_back({keys[i], static_cast<int>(i)});
  for (int shift = 0; shift < 64; shift += digit_bits) {
    const auto digit = [&](std::uint64_t key) { return key >> shift & (digit_values - 1); };
    if (digit(differing) == 0) continue;
    std::array<std::size_t, digit_values> begin{};
    for (const Item& item : items) ++begin[digit(item.key)];
    std::exclusive_scan(begin.begin(), begin.end(), begin.begin(), std::size_t{0});
    for (const Item& item : items) sorted[begin[digit(item.key)]++] = item;
    std::swap(items, sorted);
  }
  for (std::size_t i = 0; i < items.size(); ++i) order[i] = items[i].place;
  return order;
}

}  // namespace luxel
