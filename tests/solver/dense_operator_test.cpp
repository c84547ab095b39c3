#include "luxel/dense_operator.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>
#include <random>
#include <tuple>

namespace luxel {
namespace {

struct System {
  ExchangeMatrix exchange;
  std::vector<double> areas;
  Eigen::MatrixXd full;  // the same, dense, without precision lost
};

System random_system(int size, Precision precision, unsigned seed = 1) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  System system{ExchangeMatrix(size, precision), {}, Eigen::MatrixXd::Zero(size, size)};
  for (int i = 0; i < size; ++i) {
    system.areas.push_back(0.1 + unit(random));
    for (int j = 0; j < i; ++j) {
      system.exchange.set(i, j, unit(random) / size);
      system.full(i, j) = system.full(j, i) = system.exchange(i, j);
    }
  }
  return system;
}

PatchField random_field(int rows, int columns) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit(-1, 1);
  PatchField x(rows, columns);
  for (int i = 0; i < rows; ++i) {
    for (int c = 0; c < columns; ++c) x(i, c) = unit(random);
  }
  return x;
}

class DenseOperatorOfAnySize : public ::testing::TestWithParam<std::tuple<int, Precision>> {};

TEST_P(DenseOperatorOfAnySize, AppliesTheMatrixToAnyNumberOfColumns) {
  const auto [size, precision] = GetParam();
  System system = random_system(size, precision);
  const DenseOperator transport(std::move(system.exchange), system.areas);
  const Eigen::Map<Eigen::VectorXd> areas(system.areas.data(), size);

  for (int columns = 1; columns <= 7; ++columns) {
    const PatchField x = random_field(size, columns);
    PatchField y(size, columns);
    transport.apply(x.data(), y.data(), columns);

    const PatchField expected = areas.cwiseInverse().asDiagonal() * (system.full * x);
    // sums of `size` products in float64, each below 10 / size
    EXPECT_LE((y - expected).cwiseAbs().maxCoeff(), 1e-14) << columns << " columns";
  }
}

TEST_P(DenseOperatorOfAnySize, ItsRowSumsAreItselfAppliedToOnes) {
  const auto [size, precision] = GetParam();
  System system = random_system(size, precision);
  const DenseOperator transport(std::move(system.exchange), system.areas);
  const std::vector<double> ones(size, 1.0);
  std::vector<double> y(size);

  transport.apply(ones.data(), y.data(), 1);

  for (int i = 0; i < size; ++i) EXPECT_EQ(transport.row_sums()[i], y[i]);
}

// around the widths of bands (8), panels (4, 2), vectors (4, 8) and blocks (512)
INSTANTIATE_TEST_SUITE_P(Sizes, DenseOperatorOfAnySize,
                         ::testing::Combine(::testing::Values(1, 2, 3, 4, 5, 7, 8, 9, 15, 16, 17, 31, 100,
                                                              511, 512, 513, 1024, 1025, 1100),
                                            ::testing::Values(Precision::float32, Precision::float64)));

TEST(DenseOperator, AddsItsDiagonal) {
  System system = random_system(20, Precision::float64);
  std::vector<double> diagonal(20);
  for (int i = 0; i < 20; ++i) diagonal[i] = 1e-3 * i;
  const DenseOperator transport(std::move(system.exchange), system.areas, diagonal);
  const PatchField x = random_field(20, 3);
  PatchField y(20, 3);

  transport.apply(x.data(), y.data(), 3);

  for (int i = 0; i < 20; ++i) {
    for (int c = 0; c < 3; ++c) {
      const double expected = (system.full.row(i).dot(x.col(c)) + diagonal[i] * x(i, c)) / system.areas[i];
      EXPECT_NEAR(y(i, c), expected, 1e-14);  // 20 products of order 0.1 in float64
    }
  }
}

TEST(DenseOperator, IsSymmetricInTheAreas) {
  System system = random_system(900, Precision::float32);
  const DenseOperator transport(std::move(system.exchange), system.areas);
  const PatchField x = random_field(900, 2);
  PatchField y(900, 2);
  transport.apply(x.data(), y.data(), 2);
  const Eigen::Map<const Eigen::VectorXd> areas(transport.areas().data(), 900);

  const double left = x.col(0).dot(areas.asDiagonal() * y.col(1));
  const double right = x.col(1).dot(areas.asDiagonal() * y.col(0));

  // 810 000 products of order 1e-3 in float64
  EXPECT_NEAR(left, right, 1e-13 * 900);
}

TEST(DenseOperator, GivesTheSameBitsForAnyNumberOfThreads) {
  System system = random_system(3000, Precision::float32);
  const DenseOperator transport(std::move(system.exchange), system.areas);
  const PatchField x = random_field(3000, 3);
  PatchField one(3000, 3), more(3000, 3);

  {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    transport.apply(x.data(), one.data(), 3);
  }
  for (int repeat = 0; repeat < 5; ++repeat) {
    transport.apply(x.data(), more.data(), 3);

    ASSERT_EQ(std::memcmp(one.data(), more.data(), sizeof(double) * 9000), 0);
  }
}

TEST(DenseOperator, RefusesShapesThatDoNotFit) {
  EXPECT_THROW(DenseOperator(ExchangeMatrix(3, Precision::float32), {1, 1}), std::invalid_argument);
  EXPECT_THROW(DenseOperator(ExchangeMatrix(2, Precision::float32), {1, 1}, {0}), std::invalid_argument);
  EXPECT_THROW(DenseOperator(ExchangeMatrix(2, Precision::float32), {1, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace luxel
