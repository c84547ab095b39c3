#include "stress/stress_text.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include <fmt/format.h>

namespace luxel::stress {

namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

std::string field(double value) {
  return std::isfinite(value) ? fmt::format("{:.9g}", value) : "";
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (char c : text) result += c == '"' ? "\"\"" : std::string(1, c);
  return result + "\"";
}

// One number where every patch is expected to have it, a list of [low, high] else.
Json expected_value(const Expectation& expected) {
  if (expected.radiosity.empty()) return nullptr;
  const PatchValue& first = expected.radiosity.front();
  const bool uniform = std::ranges::all_of(expected.radiosity, [&](const PatchValue& value) {
    return value.low == value.high && value.low == first.low;
  });
  if (uniform) return first.low;
  Json values = Json::array();
  for (const PatchValue& value : expected.radiosity) {
    values.push_back({{"patch", value.patch}, {"low", value.low}, {"high", value.high}});
  }
  return values;
}

Json to_json(const SolverVerdict& run) {
  return {{"solver", luxel::name(run.method)},
          {"verdict", name(run.verdict)},
          {"error", number(run.error)},
          {"error_bound", number(run.error_bound)},
          {"relative_residual", number(run.relative_residual)},
          {"iterations", run.iterations},
          {"message", run.message}};
}

}  // namespace

std::string to_table(const std::vector<CaseVerdicts>& cases) {
  std::size_t width = 4;
  for (const CaseVerdicts& row : cases) width = std::max(width, row.stress_case.name.size());
  std::string text = fmt::format("{:<{}}", "case", width);
  if (!cases.empty()) {
    for (const SolverVerdict& run : cases.front().solvers)
      text += fmt::format("  {:>22}", luxel::name(run.method));
  }
  text += "\n";
  for (const CaseVerdicts& row : cases) {
    text += fmt::format("{:<{}}", row.stress_case.name, width);
    for (const SolverVerdict& run : row.solvers) {
      const std::string error = std::isfinite(run.error) ? fmt::format(" {:.1e}", run.error) : "";
      text +=
          fmt::format("  {:>22}", fmt::format("{}{}{}", run.allowed ? "" : "! ", name(run.verdict), error));
    }
    text += "\n";
  }
  return text;
}

std::string to_json(const std::vector<CaseVerdicts>& cases) {
  Json list = Json::array();
  for (const CaseVerdicts& row : cases) {
    const Expectation& expected = row.stress_case.expected;
    Json solvers = Json::array(), allowed = Json::array();
    for (const SolverVerdict& run : row.solvers) solvers.push_back(to_json(run));
    for (Verdict verdict : row.stress_case.allowed) allowed.push_back(name(verdict));
    list.push_back({{"name", row.stress_case.name},
                    {"what", row.stress_case.what},
                    {"expected",
                     {{"kind", name(expected.kind)},
                      {"value", expected_value(expected)},
                      {"tolerance", expected.tolerance},
                      {"tolerance_reason", expected.tolerance_reason},
                      {"source", expected.source}}},
                    {"allowed", std::move(allowed)},
                    {"solvers", std::move(solvers)}});
  }
  return Json{{"cases", std::move(list)}}.dump(1) + "\n";
}

std::string to_csv(const std::vector<CaseVerdicts>& cases) {
  std::string text = "case,solver,verdict,allowed,error,error_bound,relative_residual,iterations,message\n";
  for (const CaseVerdicts& row : cases) {
    for (const SolverVerdict& run : row.solvers) {
      text +=
          fmt::format("{},{},{},{},{},{},{},{},{}\n", row.stress_case.name, luxel::name(run.method),
                      name(run.verdict), run.allowed ? "yes" : "no", field(run.error), field(run.error_bound),
                      field(run.relative_residual), run.iterations, quoted(run.message));
    }
  }
  return text;
}

}  // namespace luxel::stress
