// luxel compare and luxel stress through the program.
#include <gtest/gtest.h>

#include "app/program.h"

namespace luxel::test {
namespace {

using nlohmann::json;

std::string lit_room(const Folder& folder) {
  return folder.write("scene.json", scene_text("room_with_block", {{"white", {{"reflectance", 0.8}}}},
                                               {{"ceiling", {{"exitance", 1}}}}));
}

TEST(Compare, HoldsEveryErrorUnderItsBound) {
  const Folder folder;

  const Outcome outcome = luxel({"compare", lit_room(folder), "--patches", "300", "--json", "--quiet"});

  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const json report = json::parse(outcome.out);
  EXPECT_GE(report["runs"].size(), 8u);
  for (const json& run : report["runs"]) {
    ASSERT_TRUE(run["error_bound"].is_number()) << run;
    // the reference is right to its own bound
    EXPECT_LE(run["error"].get<double>(),
              run["error_bound"].get<double>() + report["reference"]["error"].get<double>())
        << run["solver"];
  }
}

TEST(Compare, MeasuresAgainstAFileWhereOneIsGiven) {
  const Folder folder;
  const std::string scene = lit_room(folder);
  luxel({"solve", scene, "--patches", "300", "--tolerance", "1e-12", "--full-precision", "-o",
         folder.path("b.csv")});

  const Outcome outcome = luxel({"compare", scene, "--patches", "300", "--solver", "cg", "--reference",
                                 folder.path("b.csv"), "--json"});

  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const json report = json::parse(outcome.out);
  EXPECT_EQ(report["reference"]["kind"], "file");
  // the plan of solve may lay the operator out otherwise: both are right to the accuracy asked, 1e-3
  EXPECT_LE(report["runs"][0]["error"].get<double>(), 1e-3);
}

TEST(Compare, RefusesAReferenceOfAnotherMesh) {
  const Folder folder;
  const std::string file = folder.write("b.csv", "patch,B_r,B_g,B_b\n0,1,1,1\n");

  const Outcome outcome = luxel({"compare", lit_room(folder), "--as-is", "--reference", file});

  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(line_count(outcome.err), 1) << outcome.err;
  EXPECT_NE(outcome.err.find("b.csv"), std::string::npos);
}

TEST(Stress, EveryVerdictIsOneThatItsCaseAllows) {
  const Outcome outcome = luxel({"stress", "--json"});

  EXPECT_EQ(outcome.status, 0);
  const json report = json::parse(outcome.out);
  EXPECT_GE(report["cases"].size(), 25u);
  for (const json& each : report["cases"]) {
    for (const json& run : each["solvers"]) {
      EXPECT_NE(run["verdict"], "failed") << each["name"] << " " << run["solver"] << ": " << run["message"];
    }
  }
}

TEST(Stress, NamesTheNearestCaseOfOneMistyped) {
  const Outcome outcome = luxel({"stress", "pinhole_bax"});

  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(line_count(outcome.err), 1) << outcome.err;
  EXPECT_NE(outcome.err.find("pinhole_box"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace luxel::test
