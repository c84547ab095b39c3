#include "order_by_key.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace luxel {
namespace {

TEST(OrderByKey, IsThatOfAStableSort) {
  std::mt19937_64 random(1);
  for (const std::size_t count : {0u, 1u, 100u, 20000u}) {
    for (const std::uint64_t most : {std::uint64_t{3}, std::uint64_t{1} << 33, ~std::uint64_t{0}}) {
      std::vector<std::uint64_t> keys(count);
      for (std::uint64_t& key : keys) key = std::uniform_int_distribution<std::uint64_t>(0, most)(random);
      std::vector<int> expected(count);
      std::iota(expected.begin(), expected.end(), 0);
      std::stable_sort(expected.begin(), expected.end(), [&](int a, int b) { return keys[a] < keys[b]; });

      EXPECT_EQ(order_by_key(keys), expected);
    }
  }
}

}  // namespace
}  // namespace luxel
