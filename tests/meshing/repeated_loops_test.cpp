#include "repeated_loops.h"

#include <gtest/gtest.h>

namespace luxel {
namespace {

Loops loops_of(const std::vector<std::vector<int>>& lists) {
  Loops loops;
  for (const auto& list : lists) loops.append(list);
  return loops;
}

TEST(RepeatedLoops, AreFoundWhereverTheyStartAndWhicheverWayTheyRun) {
  const RepeatedLoops repeated = find_repeated(
      loops_of({{5, 1, 7, 3}, {1, 2, 3}, {7, 3, 5, 1}, {3, 2, 1}, {1, 5, 3, 7}, {5, 7, 1, 3}, {2, 3, 1}}));

  EXPECT_EQ(repeated.first, (std::vector<int>{0, 1, 0, 1, 0, 5, 1}));
  EXPECT_EQ(repeated.reversed, (std::vector<char>{0, 0, 0, 1, 1, 0, 0}));
}

TEST(RepeatedLoops, AreToldFromOthersAroundTheSameCorner) {
  std::vector<std::vector<int>> lists;
  for (int k = 1; k <= 300; ++k) lists.push_back({0, k, k + 1});
  for (int k = 300; k >= 1; --k) lists.push_back({k + 1, k, 0});

  const RepeatedLoops repeated = find_repeated(loops_of(lists));

  for (int i = 0; i < 300; ++i) {
    EXPECT_EQ(repeated.first[i], i);
    EXPECT_EQ(repeated.first[599 - i], i);
    EXPECT_TRUE(repeated.reversed[599 - i]);
  }
}

TEST(RepeatedLoops, MayBeShortOrEmpty) {
  const RepeatedLoops repeated = find_repeated(loops_of({{}, {4}, {1, 2}, {}, {2, 1}, {4}, {1, 2}}));

  EXPECT_EQ(repeated.first, (std::vector<int>{0, 1, 2, 0, 4, 1, 2}));
  EXPECT_TRUE(find_repeated({}).first.empty());
}

}  // namespace
}  // namespace luxel
