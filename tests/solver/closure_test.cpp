#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>
#include <random>

#include "luxel/dense_operator.h"
#include "luxel/input_error.h"

namespace luxel {
namespace {

/// Patches of a sphere of radius 1: F_ij = A_j / 4 pi whatever their shapes, the diagonal included; the true
/// rows then sum to 1 with A_i A_j / 4 pi. Without the diagonal (flat patches) they do only after scaling.
struct Sphere {
  ExchangeMatrix exchange;
  std::vector<double> areas;
};

Sphere sphere(int size, Precision precision, double noise, unsigned seed = 1) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  Sphere result{ExchangeMatrix(size, precision), {}};
  double total = 0;
  for (int i = 0; i < size; ++i) total += result.areas.emplace_back(0.5 + unit(random));
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < i; ++j) {
      const double factor = 1 + noise * (2 * unit(random) - 1);
      result.exchange.set(i, j, factor * result.areas[i] * result.areas[j] / total);
    }
  }
  return result;
}

Enclosures all_closed(int size) {
  Enclosures enclosures;
  enclosures.closed = true;
  enclosures.count = 1;
  enclosures.enclosure.assign(size, 0);
  enclosures.enclosure_closed = {1};
  enclosures.open_share.assign(size, 0.0);
  enclosures.back_share.assign(size, 0.0);
  enclosures.share_error.assign(size, 0.0);
  return enclosures;
}

class ClosureOfAnyPrecision : public ::testing::TestWithParam<Precision> {};

TEST_P(ClosureOfAnyPrecision, RowsSumToOneToTwelveDigits) {
  Sphere raw = sphere(700, GetParam(), 1e-2);

  const ClosedOperator closed = close_rows(std::move(raw.exchange), raw.areas, all_closed(700));

  EXPECT_TRUE(closed.closure.applied);
  EXPECT_EQ(closed.closure.message, "");
  EXPECT_GT(closed.closure.before.max, 1e-3);  // the diagonal that is not there
  EXPECT_LE(closed.closure.after.max, 1e-12);
  for (double sum : closed.transport->row_sums()) EXPECT_NEAR(sum, 1, 1e-12);
}

TEST_P(ClosureOfAnyPrecision, OnlyRoundingGoesToTheDiagonal) {
  Sphere raw = sphere(700, GetParam(), 1e-2);

  const ClosedOperator closed = close_rows(std::move(raw.exchange), raw.areas, all_closed(700));

  // each entry is rounded down, by a unit in the last place at most; or what the scaling leaves, 1e-12
  const double rounding = GetParam() == Precision::float32 ? 1.2e-7 : 1e-12;
  for (int i = 0; i < 700; ++i) {
    EXPECT_GE(closed.transport->diagonal()[i], 0);
    EXPECT_LE(closed.transport->diagonal()[i], rounding * raw.areas[i]);
  }
}

TEST_P(ClosureOfAnyPrecision, EntriesStayWithinWhatEitherPatchCanSend) {
  // two patches that see each other and little else
  ExchangeMatrix exchange(4, GetParam());
  exchange.set(1, 0, 0.9);
  exchange.set(2, 0, 0.05);
  exchange.set(3, 1, 0.05);
  exchange.set(3, 2, 0.9);
  const std::vector<double> areas{1, 1, 1, 1};

  const ClosedOperator closed = close_rows(std::move(exchange), areas, all_closed(4));

  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < i; ++j) {
      const double entry = (*closed.transport->entries())(i, j);
      EXPECT_GE(entry, 0);
      EXPECT_LE(entry, 1);
    }
  }
  EXPECT_LE(closed.closure.after.max, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Precisions, ClosureOfAnyPrecision,
                         ::testing::Values(Precision::float32, Precision::float64));

TEST(Closure, FindsTheFactorsThatWereTakenOut) {
  // a symmetric matrix with rows of 1, disturbed by d_i d_j: the scaling must give it back
  const int size = 300;
  Sphere raw = sphere(size, Precision::float64, 0);
  Enclosures enclosures = all_closed(size);
  const ClosedOperator exact = close_rows(std::move(raw.exchange), raw.areas, enclosures);
  ExchangeMatrix disturbed(size, Precision::float64);
  const auto factor = [](int i) { return 1 + 0.02 * std::sin(i); };
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < i; ++j)
      disturbed.set(i, j, factor(i) * factor(j) * (*exact.transport->entries())(i, j));
  }

  const ClosedOperator closed = close_rows(std::move(disturbed), raw.areas, enclosures);

  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < i; ++j) {
      const double expected = (*exact.transport->entries())(i, j);
      ASSERT_NEAR((*closed.transport->entries())(i, j), expected, 1e-11 * expected);  // rows hold to 1e-12
    }
  }
  EXPECT_NEAR(closed.closure.largest_correction, 1 / (0.98 * 0.98) - 1, 1e-3);  // two sines near -1
}

TEST(Closure, LeavesOpenEnclosuresAlone) {
  Sphere raw = sphere(50, Precision::float32, 1e-2);
  Enclosures enclosures = all_closed(50);
  enclosures.closed = false;
  enclosures.enclosure_closed = {0};
  enclosures.open_share.assign(50, 0.01);
  const ExchangeMatrix& before = raw.exchange;
  std::vector<double> entries;
  for (int i = 0; i < 50; ++i) {
    for (int j = 0; j < i; ++j) entries.push_back(before(i, j));
  }

  const ClosedOperator closed = close_rows(std::move(raw.exchange), raw.areas, enclosures);

  EXPECT_FALSE(closed.closure.applied);
  EXPECT_EQ(closed.closure.largest_correction, 0);
  EXPECT_EQ(closed.closure.before.max, closed.closure.after.max);
  std::size_t k = 0;
  for (int i = 0; i < 50; ++i) {
    for (int j = 0; j < i; ++j) EXPECT_EQ((*closed.transport->entries())(i, j), entries[k++]);
    EXPECT_EQ(closed.transport->diagonal()[i], 0);
  }
}

TEST(Closure, ClosesTheClosedEnclosureBesideAnOpenOne) {
  ExchangeMatrix exchange(5, Precision::float64);
  exchange.set(1, 0, 0.51);
  exchange.set(2, 0, 0.49);
  exchange.set(2, 1, 0.48);
  exchange.set(4, 3, 0.3);
  Enclosures enclosures = all_closed(5);
  enclosures.closed = false;
  enclosures.count = 2;
  enclosures.enclosure = {0, 0, 0, 1, 1};
  enclosures.enclosure_closed = {1, 0};
  enclosures.open_share = {0, 0, 0, 0.6, 0.7};
  enclosures.back_share = {0, 0, 0, 0.1, 0};

  const ClosedOperator closed = close_rows(std::move(exchange), {1, 1, 1, 1, 1}, enclosures);

  EXPECT_TRUE(closed.closure.applied);
  // three equal patches in a closed room: 1/2 each by symmetry
  EXPECT_NEAR((*closed.transport->entries())(1, 0), 0.5, 1e-12);
  EXPECT_NEAR((*closed.transport->entries())(2, 0), 0.5, 1e-12);
  EXPECT_NEAR((*closed.transport->entries())(2, 1), 0.5, 1e-12);
  EXPECT_EQ((*closed.transport->entries())(4, 3), 0.3);
  EXPECT_NEAR(closed.closure.after.max, 0, 1e-12);
}

TEST(Closure, HoldsForRoomsCoupledByALittle) {
  // two rooms of 40 patches that exchange 1e-9 of their light
  const int half = 40;
  ExchangeMatrix exchange(2 * half, Precision::float64);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 2 * half; ++i) {
    for (int j = 0; j < i; ++j) {
      const bool together = (i < half) == (j < half);
      exchange.set(i, j, (together ? 1.0 : 1e-9) / half * (1 + 1e-3 * unit(random)));
    }
  }

  const ClosedOperator closed =
      close_rows(std::move(exchange), std::vector<double>(2 * half, 1.0), all_closed(2 * half));

  EXPECT_LE(closed.closure.after.max, 1e-12);
  EXPECT_LE(closed.closure.largest_correction, 0.1);
}

TEST(Closure, LeavesARowOfZeros) {
  ExchangeMatrix exchange(4, Precision::float32);
  exchange.set(1, 0, 0.5);
  exchange.set(2, 0, 0.5);
  exchange.set(2, 1, 0.49);

  const ClosedOperator closed = close_rows(std::move(exchange), {1, 1, 1, 1}, all_closed(4));

  EXPECT_TRUE(closed.closure.applied);
  EXPECT_EQ(closed.transport->row_sums()[3], 0);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(closed.transport->row_sums()[i], 1, 1e-12);
}

TEST(Closure, SaysWhichEnclosureCannotBeClosed) {
  // patch 0 is larger than all that it sees: no matrix with these zeros has rows of 1
  ExchangeMatrix exchange(6, Precision::float64);
  exchange.set(1, 0, 0.4);
  exchange.set(2, 0, 0.4);
  exchange.set(4, 3, 0.51);
  exchange.set(5, 3, 0.51);
  exchange.set(5, 4, 0.51);
  Enclosures enclosures = all_closed(6);
  enclosures.count = 2;
  enclosures.enclosure = {0, 0, 0, 1, 1, 1};
  enclosures.enclosure_closed = {1, 1};

  const ClosedOperator closed = close_rows(std::move(exchange), {3, 1, 1, 1, 1, 1}, enclosures);

  EXPECT_NE(closed.closure.message.find("patch 0"), std::string::npos) << closed.closure.message;
  EXPECT_EQ((*closed.transport->entries())(1, 0), 0.4);
  EXPECT_TRUE(closed.closure.applied);  // to the other enclosure
  for (int i = 3; i < 6; ++i) EXPECT_NEAR(closed.transport->row_sums()[i], 1, 1e-12);
}

TEST(Closure, IsRefusedWhereItWouldChangeEntriesByTooMuch) {
  // two spheres; the entries of the first are all 4 % too small: factors of 1 / 0.96 close it, but for
  // the diagonals, which flat patches do not have
  const int size = 200;
  const Sphere one = sphere(size, Precision::float64, 0);
  ExchangeMatrix exchange(2 * size, Precision::float64);
  std::vector<double> areas = one.areas;
  areas.insert(areas.end(), one.areas.begin(), one.areas.end());
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < i; ++j) {
      exchange.set(i, j, 0.96 * one.exchange(i, j));
      exchange.set(size + i, size + j, one.exchange(i, j));
    }
  }
  Enclosures enclosures = all_closed(2 * size);
  enclosures.count = 2;
  enclosures.enclosure_closed = {1, 1};
  for (int i = size; i < 2 * size; ++i) enclosures.enclosure[i] = 1;
  const double first = exchange(7, 3), second = exchange(size + 7, size + 3);

  const ClosedOperator closed = close_rows(std::move(exchange), areas, enclosures, {}, 0.02);

  // two patches' diagonals, of up to 1.5 / 200 each, come on top
  EXPECT_GT(closed.closure.refused_correction, 1 / 0.96 - 1);
  EXPECT_LT(closed.closure.refused_correction, 1 / 0.96 - 1 + 0.02);
  EXPECT_LT(closed.closure.unclosed, size);
  EXPECT_GE(closed.closure.unclosed, 0);
  EXPECT_NE(closed.closure.message.find("patch"), std::string::npos) << closed.closure.message;
  EXPECT_TRUE(closed.closure.applied);  // to the other sphere
  EXPECT_LT(closed.closure.largest_correction, 0.02);
  EXPECT_EQ((*closed.transport->entries())(7, 3), first);
  EXPECT_GT((*closed.transport->entries())(size + 7, size + 3), second);
  EXPECT_NEAR(closed.transport->row_sums()[size], 1, 1e-12);
  EXPECT_LT(closed.transport->row_sums()[0], 0.97);
}

TEST(Closure, GivesTheSameBitsForAnyNumberOfThreads) {
  const auto close = [] {
    Sphere raw = sphere(1500, Precision::float32, 1e-2);
    return close_rows(std::move(raw.exchange), raw.areas, all_closed(1500));
  };
  const ClosedOperator more = close();

  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  const ClosedOperator one = close();

  EXPECT_EQ(std::memcmp(one.transport->entries()->row<float>(0), more.transport->entries()->row<float>(0),
                        one.transport->entries()->bytes()),
            0);
  EXPECT_EQ(
      std::memcmp(one.transport->diagonal().data(), more.transport->diagonal().data(), 1500 * sizeof(double)),
      0);
}

TEST(Closure, StopsWhenAsked) {
  Sphere raw = sphere(50, Precision::float32, 1e-2);

  EXPECT_THROW(close_rows(std::move(raw.exchange), raw.areas, all_closed(50),
                          [](auto, double, double) { return false; }),
               Cancelled);
}

TEST(RowSumErrorOf, CountsWhatEscapesAndWhatMeetsABack) {
  Enclosures enclosures = all_closed(2);
  enclosures.open_share = {0.25, 0};
  enclosures.back_share = {0.25, 0.5};
  const std::vector<double> sums{0.5, 0.4}, areas{3, 1};

  const RowSumError error = row_sum_error(sums, areas, enclosures);

  EXPECT_NEAR(error.max, 0.1, 1e-15);
  EXPECT_NEAR(error.rms, 0.05, 1e-15);  // sqrt(1 * 0.1^2 / 4)
  EXPECT_EQ(error.sampling_rms, 0);
  EXPECT_EQ(error.max_beyond_sampling, error.max);
}

TEST(RowSumErrorOf, TellsWhatTheRaysMayHaveCaused) {
  Enclosures enclosures = all_closed(2);
  enclosures.open_share = {0.5, 0.5};
  enclosures.share_error = {0.02, 0};
  const std::vector<double> sums{0.4, 0.49}, areas{1, 3};

  const RowSumError error = row_sum_error(sums, areas, enclosures);

  EXPECT_NEAR(error.max, 0.1, 1e-15);
  EXPECT_NEAR(error.max_beyond_sampling, 0.04, 1e-15);  // 0.1 - 3 * 0.02; the other row is off by 0.01
  EXPECT_NEAR(error.sampling_rms, 0.01, 1e-15);         // sqrt(1 * 0.02^2 / 4)
}

}  // namespace
}  // namespace luxel
