#include "luxel/write_csv.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

#include "io/scratch.h"
#include "io/small_mesh.h"
#include "luxel/input_error.h"

namespace luxel {
namespace {

using testing::content;
using testing::Scratch;

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> result;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) result.push_back(line);
  return result;
}

RadiositySolution thirds(int patches) {
  return testing::solution(PatchField::Constant(patches, 3, 1.0 / 3),
                           PatchField::Constant(patches, 3, 2e-20));
}

TEST(CsvField, LeavesPlainTextAsItIs) {
  EXPECT_EQ(csv_field("wall.2 north"), "wall.2 north");
  EXPECT_EQ(csv_field(""), "");
}

TEST(CsvField, QuotesCommasQuotesAndLineBreaks) {
  EXPECT_EQ(csv_field("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_field("6\" pipe"), "\"6\"\" pipe\"");
  EXPECT_EQ(csv_field("a\nb"), "\"a\nb\"");
  EXPECT_EQ(csv_field(" a"), "\" a\"");
}

TEST(WriteCsv, HasTheHeaderAndOneRowPerPatch) {
  const Scratch scratch;
  const PatchMesh mesh = testing::half_quad_half_triangles();

  write_csv(scratch / "a.csv", mesh, thirds(3));

  const auto rows = lines(content(scratch / "a.csv"));
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0], "patch,face,group,material,area,cx,cy,cz,nx,ny,nz,E_r,E_g,E_b,H_r,H_g,H_b,B_r,B_g,B_b");
  EXPECT_EQ(
      rows[1],
      "0,0,floor,white,0.5,0.25,0.5,0,0,0,1,0,0,0,2e-20,2e-20,2e-20,0.333333333,0.333333333,0.333333333");
  // the centroid's x is (0.5 + 1 + 1) / 3
  EXPECT_EQ(rows[2],
            "1,1,floor,\"lamp, \"\"hot\"\"\",0.25,0.833333333,0.333333333,0,0,0,1,1,2,3,2e-20,2e-20,2e-20,"
            "0.333333333,0.333333333,0.333333333");
}

TEST(WriteCsv, FullPrecisionReadsBackToTheSameBits) {
  const Scratch scratch;
  const PatchMesh mesh = testing::half_quad_half_triangles();

  write_csv(scratch / "a.csv", mesh, thirds(3), {.full_precision = true});

  const std::string last_row = lines(content(scratch / "a.csv"))[3];
  EXPECT_EQ(std::strtod(last_row.substr(last_row.rfind(',') + 1).c_str(), nullptr), 1.0 / 3);
}

TEST(WriteCsv, KeepsTheOrderOverManyBlocks) {
  const Scratch scratch;
  const PatchMesh mesh = testing::inward_cube(130);  // 101,400 patches: more than one wave of blocks

  write_csv(scratch / "a.csv", mesh, thirds(mesh.size()));

  const auto rows = lines(content(scratch / "a.csv"));
  ASSERT_EQ(rows.size(), static_cast<std::size_t>(mesh.size()) + 1);
  for (int i = 0; i < mesh.size(); ++i) ASSERT_EQ(std::atoi(rows[i + 1].c_str()), i);
}

TEST(WriteCsv, OfNoPatchesIsTheHeader) {
  const Scratch scratch;

  write_csv(scratch / "a.csv", PatchMesh(), testing::solution(PatchField(0, 3), PatchField(0, 3)));

  EXPECT_EQ(lines(content(scratch / "a.csv")).size(), 1u);
}

TEST(WriteCsv, RefusesFieldsOfTheWrongShape) {
  const Scratch scratch;
  const PatchMesh mesh = testing::half_quad_half_triangles();

  EXPECT_THROW(write_csv(scratch / "a.csv", mesh, thirds(2)), std::invalid_argument);
  EXPECT_EQ(scratch.entries(), 0);
}

}  // namespace
}  // namespace luxel
