#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "luxel/report.h"

namespace luxel {
namespace {

using Json = nlohmann::json;

Report solved() {
  Report report;
  report.run = {"1.2.3", "solve", 2};
  report.scene = {"room.obj", 12, 8, 1, 24, true, 1, {"one warning"}, 3, 0.25};
  report.patches = 1234567;
  report.transport.emplace();
  report.transport->kind = "dense";
  report.transport->row_sum_error_max = 0.1;
  report.transport->bytes = 3'000'000'000;
  report.solver.emplace();
  report.solver->method = "cg";
  report.solver->converged = true;
  report.solver->relative_residual = 1.0 / 3;
  report.solver->condition_estimate = 3.5;
  report.solver->error_bound = std::numeric_limits<double>::infinity();
  report.solver->history = {{0, 0, 0, 1, not_known}, {1, 0.5, 0.25, 0.125, 0.0625}};
  report.energy.emplace();
  report.energy->emitted = {10, 8, 6};
  report.error.emplace();
  report.left_out = {{"visibility", "nothing can hide", "1 s"}};
  return report;
}

TEST(ReportJson, HasTheSectionsInTheirOrder) {
  const auto document = nlohmann::ordered_json::parse(to_json(solved()));

  std::vector<std::string> keys;
  for (const auto& [key, value] : document.items()) keys.push_back(key);
  EXPECT_EQ(keys,
            (std::vector<std::string>{"luxel", "scene", "patches", "operator", "solver", "energy", "error",
                                      "left_out", "cpu_seconds", "wall_seconds", "peak_bytes"}));
}

TEST(ReportJson, HoldsEveryFigureUnderItsName) {
  const Json document = Json::parse(to_json(solved()));

  EXPECT_EQ(document["luxel"], Json::parse(R"({"version": "1.2.3", "command": "solve", "threads": 2})"));
  EXPECT_EQ(document["scene"], Json::parse(R"({"file": "room.obj", "faces": 12, "vertices": 8, "materials": 1,
      "area": 24.0, "overlap_area": 0.25, "overlapping_faces": 3, "closed": true, "enclosures": 1, "warnings": ["one warning"]})"));
  EXPECT_EQ(document["operator"]["bytes"], 3'000'000'000);
  EXPECT_EQ(document["operator"]["row_sum_error"]["max"], 0.1);
  EXPECT_EQ(document["solver"]["relative_residual"].get<double>(), 1.0 / 3);  // the same bits
  EXPECT_EQ(document["solver"]["history"], Json::parse("[[0,0.0,0.0,1.0,null],[1,0.5,0.25,0.125,0.0625]]"));
  EXPECT_EQ(document["energy"]["emitted"], Json::parse("[10.0,8.0,6.0]"));
  EXPECT_EQ(document["left_out"][0]["why"], "nothing can hide");
}

TEST(ReportJson, WhatIsNotAFiniteNumberIsNull) {
  const Json document = Json::parse(to_json(solved()));

  EXPECT_TRUE(document["solver"]["error_bound"].is_null());
  EXPECT_EQ(document["solver"]["condition_estimate"], 3.5);
  EXPECT_TRUE(document["operator"]["row_sum_error"]["rms"].is_null());
  EXPECT_TRUE(document["error"]["operator"]["estimate"].is_null());
  EXPECT_TRUE(document["error"]["discretisation"].is_null());
}

TEST(ReportJson, LeavesOutThePartsThatTheCommandDoesNotHave) {
  const Json document = Json::parse(to_json(Report()));

  EXPECT_FALSE(document.contains("solver"));
  EXPECT_FALSE(document.contains("energy"));
  EXPECT_FALSE(document.contains("form_factors"));
  EXPECT_EQ(document["left_out"], Json::array());
}

TEST(ReportJson, HoldsFormFactorsBetweenGroups) {
  Report report;
  report.group_factors = {{"floor", "ceiling"}, {1, 4}, {{0, 0.5}, {0.125, 0}}, {0.5, not_known}};

  const Json document = Json::parse(to_json(report));

  EXPECT_EQ(document["groups"], Json::parse(R"(["floor", "ceiling"])"));
  EXPECT_EQ(document["form_factors"], Json::parse("[[0.0, 0.5], [0.125, 0.0]]"));
  EXPECT_EQ(document["open"], Json::parse("[0.5, null]"));
}

TEST(ReportJson, NamesThatAreNotUtf8StillMakeADocument) {
  Report report;
  report.scene.file = "caf\xe9.obj";

  EXPECT_EQ(Json::parse(to_json(report))["scene"]["file"], "caf\uFFFD.obj");
}

TEST(ReportJson, KeepsAHistoryEntryOnOneLine) {
  EXPECT_NE(to_json(solved()).find("\n      [1,0.5,0.25,0.125,0.0625]\n"), std::string::npos);
}

}  // namespace
}  // namespace luxel
