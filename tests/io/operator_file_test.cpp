#include "luxel/operator_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>

#include "io/scratch.h"
#include "luxel/input_error.h"
#include "solver/hand_made_mesh.h"

namespace luxel {
namespace {

namespace fs = std::filesystem;
using testing::Boxes;

class OperatorFile : public ::testing::Test {
 protected:
  testing::Scratch folder;
  fs::path path = folder / "K.luxel";
  PatchMesh mesh =
      Boxes().add({0, 0, 0}, {1, 2, 3}, true).add({0.2, 0.2, 0.2}, {0.5, 0.5, 0.5}, false).mesh();

  DenseOperator transport(Precision precision = Precision::float32) const {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> unit(0, 0.1);
    ExchangeMatrix exchange(mesh.size(), precision);
    std::vector<double> diagonal;
    for (int i = 0; i < mesh.size(); ++i) {
      diagonal.push_back(1e-9 * unit(random));
      for (int j = 0; j < i; ++j) exchange.set(i, j, unit(random));
    }
    return DenseOperator(std::move(exchange), mesh.areas, diagonal);
  }
  static OperatorRecord record() {
    OperatorRecord record;
    record.options.accuracy = 1e-5;
    record.options.seed = 7;
    record.form_factors.rays = 123456789012;
    record.closure.before.max = 1e-4;
    record.closure.applied = true;
    record.closure.message = "a sentence";
    record.enclosures.closed = true;
    record.enclosures.count = 1;
    record.enclosures.enclosure.assign(12, 0);
    record.enclosures.enclosure_closed = {1};
    record.enclosures.open_share.assign(12, 0.25);
    record.enclosures.back_share.assign(12, 0.125);
    record.enclosures.share_error.assign(12, 0.5);
    return record;
  }
  void replace(const std::string& bytes) const { std::ofstream(path, std::ios::binary) << bytes; }

  /// The one line with which loading is refused.
  std::string refusal(const PatchMesh& for_mesh) const {
    try {
      load_operator(path, for_mesh);
    } catch (const InputError& error) {
      const std::string line = error.what();
      EXPECT_EQ(line.find('\n'), std::string::npos);
      EXPECT_EQ(line.find(path.string()), 0u) << line;
      return line.substr(path.string().size());
    }
    return "not refused";
  }
};

TEST_F(OperatorFile, GivesBackTheSameBits) {
  for (const Precision precision : {Precision::float32, Precision::float64}) {
    const DenseOperator original = transport(precision);
    save_operator(path, mesh, original, record());

    const SavedOperator saved = load_operator(path, mesh);

    ASSERT_EQ(saved.transport->entries()->precision(), precision);
    const PatchField x = PatchField::Random(mesh.size(), 3);
    PatchField expected(mesh.size(), 3), found(mesh.size(), 3);
    original.apply(x.data(), expected.data(), 3);
    saved.transport->apply(x.data(), found.data(), 3);
    EXPECT_EQ(std::memcmp(expected.data(), found.data(), sizeof(double) * expected.size()), 0);
    for (int i = 0; i < mesh.size(); ++i) {
      EXPECT_EQ(saved.transport->row_sums()[i], original.row_sums()[i]);
      EXPECT_EQ(saved.transport->diagonal()[i], original.diagonal()[i]);
    }
  }
}

TEST_F(OperatorFile, GivesBackHowTheOperatorCameAbout) {
  save_operator(path, mesh, transport(), record());

  const OperatorRecord found = load_operator(path, mesh).record;

  EXPECT_EQ(found.options.accuracy, 1e-5);
  EXPECT_EQ(found.options.seed, 7u);
  EXPECT_EQ(found.form_factors.rays, 123456789012);
  EXPECT_EQ(found.closure.before.max, 1e-4);
  EXPECT_TRUE(found.closure.applied);
  EXPECT_EQ(found.closure.message, "a sentence");
  EXPECT_TRUE(found.enclosures.closed);
  EXPECT_EQ(found.enclosures.enclosure_closed, std::vector<char>{1});
  EXPECT_EQ(found.enclosures.open_share, std::vector<double>(12, 0.25));
}

TEST_F(OperatorFile, IsRefusedForAMeshThatHasMoved) {
  save_operator(path, mesh, transport(), record());
  PatchMesh moved = mesh;
  moved.vertices[0][0] += 1e-9;

  EXPECT_NE(refusal(moved).find("another mesh"), std::string::npos);
}

TEST_F(OperatorFile, IsRefusedForAnotherNumberOfPatches) {
  save_operator(path, mesh, transport(), record());

  EXPECT_NE(refusal(Boxes().add({0, 0, 0}, {1, 2, 3}, true).mesh()).find("(12 patches)"), std::string::npos);
}

TEST_F(OperatorFile, IsRefusedWhereverItIsCutOff) {
  save_operator(path, mesh, transport(), record());
  const std::string whole = testing::content(path);

  for (std::size_t size = 0; size < whole.size(); size += size < 64 ? 1 : 17) {
    replace(whole.substr(0, size));
    ASSERT_NE(refusal(mesh), "not refused") << size << " bytes";
  }
}

TEST_F(OperatorFile, IsRefusedWhicheverByteIsWrong) {
  save_operator(path, mesh, transport(), record());
  const std::string whole = testing::content(path);

  for (std::size_t k = 0; k < whole.size(); k += k < 64 ? 1 : 7) {
    std::string damaged = whole;
    damaged[k] ^= 0x10;
    replace(damaged);
    ASSERT_NE(refusal(mesh), "not refused") << "byte " << k;
  }
}

TEST_F(OperatorFile, IsRefusedWithSomethingAdded) {
  save_operator(path, mesh, transport(), record());
  replace(testing::content(path) + "x");

  EXPECT_NE(refusal(mesh).find("something was added"), std::string::npos);
}

TEST_F(OperatorFile, OfAnotherKindIsRefused) {
  replace("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n# a mesh, and no operator at all\n");

  EXPECT_NE(refusal(mesh).find("is not a saved operator"), std::string::npos);
}

TEST_F(OperatorFile, OfAnotherVersionIsRefused) {
  save_operator(path, mesh, transport(), record());
  std::string other = testing::content(path);
  other[12] = 99;  // the version, after the magic and the byte order mark
  replace(other);

  EXPECT_NE(refusal(mesh).find("version 99"), std::string::npos);
}

TEST_F(OperatorFile, ThatDoesNotExistIsRefused) {
  EXPECT_NE(refusal(mesh).find("cannot be read"), std::string::npos);
}

TEST_F(OperatorFile, IsNotLeftHalfWritten) {
  EXPECT_THROW(save_operator(path, mesh, transport(), record(), [](auto, double, double) { return false; }),
               Cancelled);

  EXPECT_EQ(folder.entries(), 0);
}

}  // namespace
}  // namespace luxel
