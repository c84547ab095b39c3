#include "luxel/write_factors.h"

#include <gtest/gtest.h>
#include <hdf5.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <sstream>

#include "io/scratch.h"
#include "luxel/input_error.h"

namespace luxel {
namespace {

namespace fs = std::filesystem;

class WriteFactors : public ::testing::Test {
 protected:
  testing::Scratch folder;

  /// A sparse operator of 150 patches: more than two bands of rows.
  static DenseOperator transport(Precision precision = Precision::float32) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> unit(0, 1);
    const int size = 150;
    ExchangeMatrix exchange(size, precision);
    std::vector<double> areas, diagonal(size, 0.0);
    for (int i = 0; i < size; ++i) {
      areas.push_back(0.5 + unit(random));
      for (int j = 0; j < i; ++j) {
        if (unit(random) < 0.3) exchange.set(i, j, unit(random) / size);
      }
    }
    diagonal[3] = 1e-9;
    return DenseOperator(std::move(exchange), areas, diagonal);
  }

  static double factor(const DenseOperator& transport, int i, int j) {
    const double exchange = i == j ? transport.diagonal()[i] : (*transport.entries())(i, j);
    return exchange / transport.areas()[i];
  }
};

TEST_F(WriteFactors, MatrixMarketHoldsEveryFactorOnce) {
  for (const Precision precision : {Precision::float32, Precision::float64}) {
    const DenseOperator original = transport(precision);
    write_factors(folder / "F.mtx", original, {.full_precision = true});

    std::ifstream file(folder / "F.mtx");
    std::string line;
    std::getline(file, line);
    EXPECT_EQ(line, "%%MatrixMarket matrix coordinate real general");
    while (file.peek() == '%') std::getline(file, line);
    int rows = 0, columns = 0;
    std::size_t entries = 0;
    file >> rows >> columns >> entries;
    std::map<std::pair<int, int>, double> found;
    int i = 0, j = 0;
    for (std::string value; file >> i >> j >> value;)
      found[{i - 1, j - 1}] = std::strtod(value.c_str(), nullptr);

    EXPECT_EQ(rows, 150);
    EXPECT_EQ(columns, 150);
    EXPECT_EQ(found.size(), entries);
    for (i = 0; i < 150; ++i) {
      for (j = 0; j < 150; ++j) {
        const auto place = found.find({i, j});
        EXPECT_EQ(place == found.end() ? 0 : place->second, factor(original, i, j));
      }
    }
  }
}

TEST_F(WriteFactors, CsvHasNineDigitsAndCountsFromZero) {
  const DenseOperator original = transport();
  write_factors(folder / "F.csv", original);

  std::ifstream file(folder / "F.csv");
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line, "i,j,F");
  std::size_t lines = 0;
  while (std::getline(file, line)) {
    int i = 0, j = 0;
    double value = 0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%d,%d,%lf", &i, &j, &value), 3);
    const double expected = factor(original, i, j);
    EXPECT_NEAR(value, expected, 5e-9 * expected);  // nine digits
    ++lines;
  }
  std::size_t entries = 0;
  for (int i = 0; i < 150; ++i) {
    for (int j = 0; j < 150; ++j) entries += factor(original, i, j) != 0;
  }
  EXPECT_EQ(lines, entries);
}

/// A whole data set of one dimension.
template <class Value>
std::vector<Value> data_set(const fs::path& path, const char* name, hid_t type) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
  const hid_t space = H5Dget_space(set);
  std::vector<Value> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  EXPECT_GE(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0) << name;
  H5Sclose(space);
  H5Dclose(set);
  H5Fclose(file);
  return values;
}

TEST_F(WriteFactors, Hdf5HoldsCompressedRows) {
  const DenseOperator original = transport();
  const fs::path path = folder / "F.h5";
  write_factors(path, original);

  const auto shape = data_set<std::int64_t>(path, "shape", H5T_NATIVE_INT64);
  const auto areas = data_set<double>(path, "areas", H5T_NATIVE_DOUBLE);
  const auto indptr = data_set<std::int64_t>(path, "indptr", H5T_NATIVE_INT64);
  const auto indices = data_set<std::int32_t>(path, "indices", H5T_NATIVE_INT32);
  const auto data = data_set<double>(path, "data", H5T_NATIVE_DOUBLE);

  EXPECT_EQ(shape, (std::vector<std::int64_t>{150, 150}));
  EXPECT_EQ(areas, std::vector<double>(original.areas().begin(), original.areas().end()));
  ASSERT_EQ(indptr.size(), 151u);
  ASSERT_EQ(static_cast<std::size_t>(indptr.back()), data.size());
  ASSERT_EQ(indices.size(), data.size());
  std::size_t k = 0;
  for (int i = 0; i < 150; ++i) {
    ASSERT_EQ(static_cast<std::size_t>(indptr[i]), k);
    for (int j = 0; j < 150; ++j) {
      if (factor(original, i, j) == 0) continue;
      ASSERT_EQ(indices[k], j);
      ASSERT_EQ(data[k], factor(original, i, j));
      ++k;
    }
  }
}

TEST_F(WriteFactors, RefusesOtherExtensions) {
  EXPECT_THROW(write_factors(folder / "F.xlsx", transport()), InputError);
  EXPECT_EQ(folder.entries(), 0);
}

TEST_F(WriteFactors, LeavesNothingBehindWhenStopped) {
  for (const char* name : {"F.mtx", "F.csv", "F.h5"}) {
    EXPECT_THROW(write_factors(folder / name, transport(), {}, [](auto, double, double) { return false; }),
                 Cancelled);
    EXPECT_EQ(folder.entries(), 0) << name;
  }
}

}  // namespace
}  // namespace luxel
