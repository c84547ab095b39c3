#include "sizing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace luxel {
namespace {

TEST(Sizing, GivesTheFinerLengthToPartsWhoseTurnHasCome) {
  const Sizing sizing = {.edge_length = 1, .finer = 0.5, .share = 0.25};

  EXPECT_EQ(sizing.at(0.2), 0.5);
  EXPECT_EQ(sizing.at(0.25), 1);
  EXPECT_EQ(sizing.parts(4, 0.2), 8);
  EXPECT_EQ(sizing.parts(4, 0.3), 4);
  EXPECT_EQ(sizing.parts(0.1, 0.3), 1);
}

TEST(Sizing, TrimsEdgesOfFourPartsAndMoreByOne) {
  Sizing sizing = {.edge_length = 1, .finer = 1, .trim = 0.5};

  EXPECT_EQ(sizing.parts(4, 0.4), 5);
  EXPECT_EQ(sizing.parts(4, 0.6), 4);
  EXPECT_EQ(sizing.parts(3, 0.4), 3);
  sizing.trim = -0.5;
  EXPECT_EQ(sizing.parts(4, 0.4), 3);
  EXPECT_EQ(sizing.parts(4, 0.6), 4);
}

TEST(Sizing, MakesNoPartLongerThanAllowed) {
  const Sizing sizing = {.edge_length = 1, .finer = 1, .longest = 0.9};

  EXPECT_EQ(sizing.parts(1.2, 0), 2);
  EXPECT_EQ(sizing.parts(0.8, 0), 1);
}

TEST(Turns, AreScatteredOverThePlaces) {
  for (const int count : {1, 7, 100, 1000}) {
    const std::vector<int> order = scattered_order(count);

    std::vector<int> all = order;
    std::sort(all.begin(), all.end());
    for (int i = 0; i < count; ++i) ASSERT_EQ(all[i], i);
    // Of the first m places half lie in the first half of the list, but for the discrepancy of multiples of
    // the golden ratio: below 1 + log(m) / log(2) for any m (Niederreiter 1992, theorem 3.3, has a smaller
    // bound).
    int in_first_half = 0;
    for (int m = 1; m <= count; ++m) {
      in_first_half += 2 * order[m - 1] < count;
      EXPECT_NEAR(in_first_half, 0.5 * m, 2 + std::log2(m));
    }
  }
}

TEST(Turns, ComeForAPolygonRightAfterItsEdges) {
  // Polygons 4 and 2 of five share the edge 1 of four; nothing has the edge 3.
  const Turns turns = take_turns({4, 2}, {{0, 1}, {1, 2}}, 5, 4);

  const double step = 1.0 / 6;  // four edges and two polygons
  EXPECT_EQ(turns.of_edge[0], 0);
  EXPECT_DOUBLE_EQ(turns.of_edge[1], step);
  EXPECT_DOUBLE_EQ(turns.of_polygon[4], 2 * step);
  EXPECT_DOUBLE_EQ(turns.of_edge[2], 3 * step);
  EXPECT_DOUBLE_EQ(turns.of_polygon[2], 4 * step);
  EXPECT_EQ(turns.of_edge[3], 1);
  EXPECT_EQ(turns.of_polygon[0], 1);
}

}  // namespace
}  // namespace luxel
