// What the program does around the numbers: streams, exit statuses, Ctrl-C, repeatability.
#include <gtest/gtest.h>

#include "app/program.h"

namespace luxel::test {
namespace {

using nlohmann::json;

const json lit_room = {{"white", {{"reflectance", 0.7}}}};
const json ceiling_lamp = {{"ceiling", {{"reflectance", 0.8}, {"exitance", {10, 8, 6}}}}};

TEST(Program, HelpNamesTheCommandsThatAreBuiltAndNoOthers) {
  const Outcome outcome = luxel({"--help"});

  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err, "");
  for (const char* command : {"solve", "factors", "compare", "stress", "inspect", "Examples"}) {
    EXPECT_NE(outcome.out.find(command), std::string::npos) << command;
  }
  for (const char* command : {"render"}) {
    EXPECT_EQ(outcome.out.find(std::string("  ") + command), std::string::npos) << command;
  }
}

TEST(Program, HelpOfSolveTellsUnitsDefaultsAndExamples) {
  const Outcome outcome = luxel({"solve", "--help"});

  EXPECT_EQ(outcome.status, 0);
  for (const char* word :
       {"Usage: luxel solve", "[m]", "W/m2", "default: 1e-6", "default: 1e-3", "Examples"}) {
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word << "\n" << outcome.out;
  }
}

TEST(Program, VersionTellsTheLicence) {
  const Outcome outcome = luxel({"--version"});

  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out.rfind("luxel 0.", 0), 0u);
  EXPECT_NE(outcome.out.find("Apache-2.0"), std::string::npos);
}

TEST(Program, SummaryGoesToStdoutAndNothingToStderr) {
  const Folder folder;
  const std::string scene = folder.write("scene.json", scene_text("cube", lit_room, ceiling_lamp));

  const Outcome outcome = luxel({"solve", scene, "--as-is"});

  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(outcome.out.find("patches"), std::string::npos);
}

TEST(Program, QuietSaysNothing) {
  const Folder folder;
  const std::string scene = folder.write("scene.json", scene_text("cube", lit_room, ceiling_lamp));

  const Outcome outcome = luxel({"solve", scene, "--as-is", "--quiet", "-o", folder.path("a.csv")});

  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out + outcome.err, "");
  EXPECT_EQ(folder.files(), (std::vector<std::string>{"a.csv", "scene.json"}));
}

TEST(Program, JsonIsOneDocumentWithEveryPartOfTheReport) {
  const Folder folder;
  const std::string scene = folder.write("scene.json", scene_text("cube", lit_room, ceiling_lamp));

  const Outcome outcome = luxel({"solve", scene, "--as-is", "--json", "-o", folder.path("a.json")});

  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json report = json::parse(outcome.out);
  EXPECT_EQ(report["luxel"]["command"], "solve");
  EXPECT_EQ(report["patches"], 6);
  EXPECT_EQ(report["scene"]["faces"], 6);
  EXPECT_EQ(report["scene"]["closed"], true);
  EXPECT_EQ(report["scene"]["enclosures"], 1);
  EXPECT_NEAR(report["scene"]["area"].get<double>(), 6, 1e-12);
  for (const char* part : {"operator", "solver", "energy", "error", "left_out"})
    EXPECT_TRUE(report.contains(part));
  EXPECT_TRUE(report["solver"]["converged"].get<bool>());
  EXPECT_FALSE(report["solver"]["history"].empty());
  EXPECT_GT(report["cpu_seconds"].get<double>(), 0);
  EXPECT_GT(report["wall_seconds"].get<double>(), 0);
  EXPECT_GT(report["peak_bytes"].get<double>(), 1e6);
  EXPECT_EQ(json::parse(folder.read("a.json"))["patches"], 6);
}

TEST(Program, WarningsGoToStderrAndIntoTheReport) {
  const Folder folder;

  const Outcome outcome = luxel({"solve", mesh("cube"), "--as-is", "--json"});

  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.err.find("warning"), std::string::npos);
  EXPECT_FALSE(json::parse(outcome.out)["scene"]["warnings"].empty());
}

TEST(Program, NoEmissionIsSolvedToExactlyZeroWithAWarning) {
  const Folder folder;
  const std::string scene = folder.write("scene.json", scene_text("cube", lit_room));

  const Outcome outcome = luxel({"solve", scene, "--as-is", "-o", folder.path("a.csv")});

  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.err.find("emits"), std::string::npos);
  for (const double b : csv_column(folder.read("a.csv"), "B_r")) EXPECT_EQ(b, 0);
}

TEST(Program, FacesTurnedInsideOutAreWarnedAbout) {
  const Folder folder;
  const json glowing = {{"white", {{"reflectance", 0.5}, {"exitance", 1}}}};
  const std::string scene = folder.write("scene.json", scene_text("cube_outward", glowing));

  const Outcome outcome = luxel({"solve", scene, "--as-is"});

  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.err.find("turned inside out"), std::string::npos) << outcome.err;
}

TEST(Program, NotConvergedIsStatusOneAndTheResultsAreWritten) {
  const Folder folder;
  const std::string scene = folder.write("scene.json", scene_text("cube", lit_room, ceiling_lamp));

  const Outcome outcome = luxel({"solve", scene, "--as-is", "--solver", "neumann", "--max-iterations", "2",
                                 "--json", "-o", folder.path("a.csv")});

  EXPECT_EQ(outcome.status, 1);
  const json report = json::parse(outcome.out);
  EXPECT_EQ(report["solver"]["converged"], false);
  EXPECT_NE(
      report["scene"]["warnings"].back().get<std::string>().find("did not converge to a relative residual"),
      std::string::npos);
  EXPECT_EQ(csv_column(folder.read("a.csv"), "B_r").size(), 6u);
}

// A lamp over a white floor that lies there twice, as-is: half of what leaves the lamp's front to the floor
// is counted twice, and rows say so.
TEST(Program, AccuracyNotReachedIsStatusOneAndSaysByHowMuch) {
  const Folder folder;
  const std::string mesh = folder.write("twice.obj",
                                        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                                        "v 0.1 0 0\nv 1.1 0 0\nv 1.1 1 0\nv 0.1 1 0\n"
                                        "v 0 0 1\nv 0 1 1\nv 1 1 1\nv 1 0 1\n"
                                        "usemtl floor\nf 1 2 3 4\nf 5 6 7 8\nusemtl lamp\nf 9 10 11 12\n");
  const std::string scene = folder.write("scene.json", R"({"mesh": "twice.obj", "materials": {
      "floor": {"reflectance": 0.5}, "lamp": {"reflectance": 0.5, "exitance": 1}}})");

  for (const std::string command : {"solve", "factors"}) {
    const Outcome kept = luxel({command, scene, "--as-is", "--json"});
    const Outcome cut = luxel({command, scene, "--patches", "200", "--json"});

    EXPECT_EQ(kept.status, 1) << command;
    EXPECT_NE(kept.err.find("luxel: warning: 1 face lies in part or all in the same plane"),
              std::string::npos);
    EXPECT_NE(kept.err.find("light counts twice"), std::string::npos) << kept.err;
    EXPECT_NE(kept.err.find("luxel: warning: the accuracy asked, 0.001, was not reached: "),
              std::string::npos)
        << kept.err;
    EXPECT_NE(kept.err.find("material \"lamp\""), std::string::npos) << kept.err;
    EXPECT_EQ(cut.status, 0) << command << cut.err;
    EXPECT_EQ(cut.err.find("not reached"), std::string::npos) << cut.err;
    const json report = json::parse(cut.out);
    EXPECT_NEAR(report["scene"]["area"].get<double>(), 2.1, 1e-12);
    EXPECT_NEAR(report["scene"]["overlap_area"].get<double>(), 0.9, 1e-12);
    EXPECT_EQ(report["scene"]["overlapping_faces"], 1);
  }
}

TEST(Program, CtrlCStopsItWithNothingWritten) {
  const Folder folder;
  const std::string scene = folder.write("scene.json", scene_text("room_with_block", lit_room, ceiling_lamp));

  // partly hidden pairs of 8000 patches to 1e-5 take seconds on any machine
  const Outcome outcome = luxel({"solve", scene, "--patches", "8000", "--accuracy", "1e-5", "-o",
                                 folder.path("a.csv"), "-o", folder.path("a.json")},
                                400);

  EXPECT_EQ(outcome.status, 130);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(folder.files(), std::vector<std::string>{"scene.json"});
}

class SameBits : public testing::TestWithParam<std::string> {};

TEST_P(SameBits, ForAnyNumberOfThreads) {
  const Folder folder;
  const std::string scene = folder.write("scene.json", scene_text("room_with_block", lit_room, ceiling_lamp));
  const auto csv = [&](const std::string& threads) {
    const std::string file = "threads" + threads + ".csv";
    const Outcome outcome =
        luxel({"solve", scene, "--patches", "700", "--solver", GetParam(), "--threads", threads,
               "--tolerance", "1e-10", "--full-precision", "--quiet", "-o", folder.path(file)});
    EXPECT_LE(outcome.status, 1) << outcome.err;
    return folder.read(file);
  };

  const std::string one = csv("1");

  EXPECT_FALSE(one.empty());
  EXPECT_TRUE(one == csv("2"));
  EXPECT_TRUE(one == csv("3"));
}

INSTANTIATE_TEST_SUITE_P(OfEverySolver, SameBits,
                         testing::Values("cholesky", "lu", "cg", "neumann", "gauss-seidel"));

TEST(Program, EmissionUnitExitanceReadsKeAsExitance) {
  const Folder folder;
  folder.write("lamp.mtl", "newmtl lamp\nKd 0 0 0\nKe 1 2 3\n");
  const std::string scene =
      folder.write("lamp.obj", "mtllib lamp.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl lamp\nf 1 2 3\n");
  const auto blue = [&](const std::string& unit) {
    luxel({"solve", scene, "--as-is", "--emission-unit", unit, "-o", folder.path("a.csv")});
    return csv_column(folder.read("a.csv"), "B_b").at(0);
  };

  EXPECT_NEAR(blue("exitance"), 3, 1e-8);
  EXPECT_NEAR(blue("radiance"), 9.42477796, 1e-7);  // 3 pi
}

TEST(Program, PatchesAreAboutAsManyAsAskedFor) {
  const Outcome outcome = luxel({"inspect", mesh("cube"), "--patches", "1000", "--json"});

  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json report = json::parse(outcome.out);
  EXPECT_EQ(report["luxel"]["command"], "inspect");
  EXPECT_NEAR(report["patches"].get<double>(), 1000, 150);
}

}  // namespace
}  // namespace luxel::test
