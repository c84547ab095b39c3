// --plan and what inspect foretells.
#include <gtest/gtest.h>

#include <algorithm>

#include "app/program.h"

namespace luxel::test {
namespace {

using nlohmann::json;

/// Two closed rooms, a lamp in the first.
std::string lamp_in_one_room(const Folder& folder) {
  const json white = {{"white", {{"reflectance", 0.7}}}, {"emit", {{"reflectance", 0.7}}}};
  const json lamp = {{"A_ceiling", {{"reflectance", 0.8}, {"exitance", {10, 8, 6}}}}};
  return folder.write("rooms.json", scene_text("two_rooms_wall_0.001", white, lamp));
}

json solved(const Folder& folder, const std::string& scene, const std::vector<std::string>& options) {
  std::vector<std::string> arguments = {"solve",  scene, "--patches",         "600",
                                        "--json", "-o",  folder.path("b.csv")};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Outcome outcome = luxel(arguments);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return json::parse(outcome.out);
}

TEST(Plan, LeavesTheDarkRoomOutAndSaysSo) {
  const Folder folder;

  const json report = solved(folder, lamp_in_one_room(folder), {});

  const std::vector<double> light = csv_column(folder.read("b.csv"), "B_r");
  const std::vector<double> x = csv_column(folder.read("b.csv"), "cx");
  ASSERT_EQ(x.size(), light.size());
  // The rooms are apart at x = 1 to 1.001.
  for (std::size_t i = 0; i < light.size(); ++i) EXPECT_EQ(light[i] > 0, x[i] < 1.0005) << i;
  ASSERT_FALSE(report["left_out"].empty());
  for (const json& item : report["left_out"]) {
    for (const char* key : {"what", "why", "saved"}) EXPECT_NE(item[key], "") << item;
  }
}

TEST(Plan, FullGivesTheSameLightAndLeavesNothingOut) {
  const Folder folder;
  const std::string scene = lamp_in_one_room(folder);
  const json planned = solved(folder, scene, {});
  const std::vector<double> light = csv_column(folder.read("b.csv"), "H_g");

  const json whole = solved(folder, scene, {"--plan", "full"});

  EXPECT_TRUE(whole["left_out"].empty());
  EXPECT_LT(planned["operator"]["bytes"], whole["operator"]["bytes"]);
  const std::vector<double> same = csv_column(folder.read("b.csv"), "H_g");
  const double largest = *std::max_element(same.begin(), same.end());
  // both operators are right to 1e-3 in the root mean square
  for (std::size_t i = 0; i < light.size(); ++i) EXPECT_NEAR(light[i], same[i], 4e-3 * largest) << i;
}

TEST(Plan, IsRefusedByAnyOtherName) {
  const Outcome outcome = luxel({"solve", mesh("cube"), "--plan", "half"});

  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("--plan: found 'half', expected auto or full"), std::string::npos)
      << outcome.err;
}

TEST(Plan, IsToldByInspectWithTimeAndMemory) {
  const Folder folder;

  const Outcome outcome = luxel({"inspect", lamp_in_one_room(folder), "--json"});

  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json report = json::parse(outcome.out);
  EXPECT_FALSE(report["left_out"].empty());
  EXPECT_GT(report["estimate"]["cpu_seconds"].get<double>(), 0);
  EXPECT_GT(report["estimate"]["bytes"].get<double>(), 1e6);
}

}  // namespace
}  // namespace luxel::test
