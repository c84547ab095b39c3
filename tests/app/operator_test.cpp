// --operator, --error-bar and what the report tells of them.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "app/program.h"

namespace luxel::test {
namespace {

using nlohmann::json;

std::string furnace(double reflectance) {
  const json finish = {{"reflectance", reflectance}, {"exitance", {1, 2, 3}}};
  return scene_text("room_with_block", {{"white", finish}});
}

std::string lit_room() {
  return scene_text("room_with_block", {{"white", {{"reflectance", 0.7}}}},
                    {{"ceiling", {{"reflectance", 0.8}, {"exitance", {10, 8, 6}}}}});
}

// In a closed room that glows alike all over, B = E / (1 - rho) everywhere.
class OperatorFurnace : public testing::TestWithParam<const char*> {};

TEST_P(OperatorFurnace, HasItsRadiosityOnEveryPatch) {
  for (const double reflectance : {0.5, 0.9}) {
    const Solved solved =
        solve(furnace(reflectance), {"--operator", GetParam(), "--patches", "500", "--accuracy", "0.01"});

    EXPECT_EQ(solved.outcome.status, 0);
    EXPECT_EQ(solved.report["operator"]["kind"], GetParam());
    EXPECT_TRUE(solved.report["scene"]["closed"]);
    const double expected = 2 / (1 - reflectance);
    // no patch is off by more than ten times the accuracy asked
    for (const double b : csv_column(solved.csv, "B_g")) EXPECT_NEAR(b, expected, 0.1 * expected);
  }
}

INSTANTIATE_TEST_SUITE_P(Operators, OperatorFurnace, testing::Values("dense", "gather", "hierarchical"),
                         [](const auto& kind) { return std::string(kind.param); });

TEST(Operator, OfAnyKindGivesTheSameLightWithinItsErrorBar) {
  std::vector<std::vector<double>> light;
  std::vector<double> high;
  for (const char* kind : {"dense", "gather", "hierarchical"}) {
    const Solved solved = solve(lit_room(), {"--operator", kind, "--patches", "700", "--accuracy", "0.01"});
    light.push_back(csv_column(solved.csv, "H_r"));
    const json& error = solved.report["error"]["operator"];
    EXPECT_LE(error["low"], error["estimate"]);
    EXPECT_LE(error["estimate"], error["high"]);
    high.push_back(error["high"]);
  }
  for (std::size_t k = 1; k < light.size(); ++k) {
    double off = 0, whole = 0;
    for (std::size_t i = 0; i < light[0].size(); ++i) {
      off += std::pow(light[k][i] - light[0][i], 2);
      whole += std::pow(light[0][i], 2);
    }
    // patches are of nearly equal area
    EXPECT_LT(std::sqrt(off / whole), 1.2 * (high[0] + high[k])) << k;
  }
}

TEST(Operator, GatherReportsWhatItMeasured) {
  const json report =
      solve(lit_room(), {"--operator", "gather", "--patches", "500", "--accuracy", "0.02"}).report;

  const json& transport = report["operator"];
  EXPECT_EQ(transport["accuracy"], 0.02);
  EXPECT_GT(transport["rays"], 500 * 16);
  EXPECT_GT(transport["bytes"], 0);
  EXPECT_EQ(transport["row_sum_error"]["max"], 0);  // closed: no ray is lost, of either kind
  EXPECT_GT(transport["reciprocity_error"], 0);
  EXPECT_FALSE(transport.contains("candidates"));
  EXPECT_LE(report["solver"]["relative_residual"], 1e-6);
  EXPECT_TRUE(report["solver"]["converged"]);
  EXPECT_LT(report["energy"]["imbalance"], 0.02);
  EXPECT_EQ(report["energy"]["escaped"][0], 0);
}

TEST(Operator, ErrorBarCanBeLeftOut) {
  for (const char* kind : {"dense", "gather", "hierarchical"}) {
    const json report = solve(lit_room(), {"--operator", kind, "--patches", "300", "--accuracy", "0.05",
                                           "--error-bar", "off"})
                            .report;

    for (const char* end : {"estimate", "low", "high"})
      EXPECT_TRUE(report["error"]["operator"][end].is_null());
    EXPECT_FALSE(report["error"]["algebraic"].is_null());
  }
}

TEST(Operator, IsChosenByCostAndMemory) {
  const json small = solve(lit_room(), {"--patches", "300"}).report;
  EXPECT_EQ(small["operator"]["kind"], "dense");
  ASSERT_EQ(small["operator"]["candidates"].size(), 3u);

  const json large =
      solve(lit_room(), {"--patches", "12000", "--accuracy", "0.1", "--memory", "120M", "--error-bar", "off"})
          .report;

  EXPECT_NE(large["operator"]["kind"], "dense");
  EXPECT_FALSE(large["operator"]["candidates"][0]["fits"]);
#ifndef __SANITIZE_ADDRESS__  // whose own memory is twice the program's
  EXPECT_LT(large["peak_bytes"], 120 << 20);
#endif
}

TEST(Operator, GivesTheSameBitsForOneAndTwoThreads) {
  for (const char* kind : {"gather", "hierarchical"}) {
    const std::vector<std::string> options = {"--operator", kind,   "--patches", "400",
                                              "--accuracy", "0.03", "--threads"};
    const auto with_threads = [&](const char* count) {
      auto all = options;
      all.push_back(count);
      return solve(lit_room(), all).csv;
    };

    const std::string one = with_threads("1");
    EXPECT_FALSE(one.empty());
    EXPECT_EQ(one, with_threads("2")) << kind;
  }
}

TEST(Operator, OtherThanDenseIsRefusedWhereEveryFormFactorIsNeeded) {
  for (const char* command : {"factors", "compare"}) {
    const Outcome outcome = luxel({command, mesh("cube"), "--operator", "gather"});

    EXPECT_EQ(outcome.status, 2);
    EXPECT_NE(outcome.err.find("--operator gather, expected dense"), std::string::npos) << outcome.err;
    EXPECT_EQ(line_count(outcome.err), 1);
  }
}

}  // namespace
}  // namespace luxel::test
