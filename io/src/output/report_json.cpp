#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "luxel/report.h"

namespace luxel {

namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

template <class Range>
Json numbers(const Range& values) {
  Json array = Json::array();
  for (const double value : values) array.push_back(number(value));
  return array;
}

Json json(const Report::Scene& scene) {
  return {{"file", scene.file},
          {"faces", scene.faces},
          {"vertices", scene.vertices},
          {"materials", scene.materials},
          {"area", number(scene.area)},
          {"overlap_area", number(scene.overlap_area)},
          {"overlapping_faces", scene.overlapping_faces},
          {"closed", scene.closed},
          {"enclosures", scene.enclosures},
          {"warnings", scene.warnings}};
}

Json json(const Report::Operator& transport) {
  Json result = {
      {"kind", transport.kind},
      {"accuracy", number(transport.accuracy)},
      {"bytes", transport.bytes},
      {"rays", transport.rays},
      {"cpu_seconds", number(transport.cpu_seconds)},
      {"wall_seconds", number(transport.wall_seconds)},
      {"row_sum_error",
       {{"max", number(transport.row_sum_error_max)}, {"rms", number(transport.row_sum_error_rms)}}},
      {"reciprocity_error", number(transport.reciprocity_error)},
      {"correction", {{"kind", transport.correction}, {"largest", number(transport.largest_correction)}}}};
  if (transport.candidates.empty()) return result;
  Json candidates = Json::array();
  for (const Report::Operator::Candidate& each : transport.candidates) {
    candidates.push_back({{"kind", each.kind},
                          {"cpu_seconds", number(each.cpu_seconds)},
                          {"bytes", each.bytes},
                          {"fits", each.fits}});
  }
  result["candidates"] = std::move(candidates);
  return result;
}

Json json(const Report::Solver& solver) {
  Json history = Json::array();
  for (const Report::HistoryEntry& entry : solver.history) {
    history.push_back(Json::array({entry.iteration, number(entry.wall_seconds), number(entry.cpu_seconds),
                                   number(entry.relative_residual), number(entry.error)}));
  }
  Json result = {{"method", solver.method},
                 {"iterations", solver.iterations},
                 {"converged", solver.converged},
                 {"relative_residual", number(solver.relative_residual)},
                 {"error_bound", number(solver.error_bound)},
                 {"condition_estimate", number(solver.condition_estimate)},
                 {"cpu_seconds", number(solver.cpu_seconds)},
                 {"wall_seconds", number(solver.wall_seconds)}};
  if (!solver.message.empty()) result["message"] = solver.message;
  result["history"] = std::move(history);
  return result;
}

Json json(const Report::Energy& energy) {
  return {{"emitted", numbers(energy.emitted)},
          {"absorbed", numbers(energy.absorbed)},
          {"escaped", numbers(energy.escaped)},
          {"imbalance", number(energy.imbalance)}};
}

Json json(const Report::Error& error) {
  return {{"algebraic", number(error.algebraic)},
          {"operator",
           {{"estimate", number(error.operator_estimate)},
            {"low", number(error.operator_low)},
            {"high", number(error.operator_high)}}},
          {"discretisation", number(error.discretisation)}};
}

void append_line(std::string& text, const Json& value) {
  text += value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// Like dump(2), but an array of plain values keeps to one line, so that a history or a matrix can be read
void append_pretty(std::string& text, const Json& value, int indent) {
  const bool nested = value.is_structured() && !value.empty() &&
                      (value.is_object() || std::any_of(value.begin(), value.end(), [](const Json& item) {
                         return item.is_structured();
                       }));
  if (!nested) return append_line(text, value);
  const std::string line_start(indent + 2, ' ');
  text += value.is_object() ? "{\n" : "[\n";
  bool first = true;
  for (const auto& [key, item] : value.items()) {
    if (!std::exchange(first, false)) text += ",\n";
    text += line_start;
    if (value.is_object()) {
      append_line(text, key);
      text += ": ";
    }
    append_pretty(text, item, indent + 2);
  }
  text.append("\n").append(indent, ' ').append(value.is_object() ? "}" : "]");
}

}  // namespace

std::string to_json(const Report& report) {
  Json document;
  document["luxel"] = {
      {"version", report.run.version}, {"command", report.run.command}, {"threads", report.run.threads}};
  document["scene"] = json(report.scene);
  document["patches"] = report.patches;
  if (report.transport) document["operator"] = json(*report.transport);
  if (report.solver) document["solver"] = json(*report.solver);
  if (report.energy) document["energy"] = json(*report.energy);
  if (report.error) document["error"] = json(*report.error);
  if (report.group_factors) {
    document["groups"] = report.group_factors->groups;
    document["areas"] = numbers(report.group_factors->areas);
    document["form_factors"] = Json::array();
    for (const auto& row : report.group_factors->form_factors) {
      document["form_factors"].push_back(numbers(row));
    }
    document["open"] = numbers(report.group_factors->open);
  }
  if (report.point_factors) {
    const Report::PointFactors& from = *report.point_factors;
    document["point"] = {{"position", numbers(from.point)}, {"normal", numbers(from.normal)},
                         {"groups", from.groups},           {"form_factors", numbers(from.form_factors)},
                         {"open", number(from.open)},       {"error", number(from.error)}};
  }
  document["left_out"] = Json::array();
  for (const Report::LeftOut& item : report.left_out) {
    document["left_out"].push_back({{"what", item.what}, {"why", item.why}, {"saved", item.saved}});
  }
  if (report.partial) document["partial"] = true;
  if (report.estimate) {
    document["estimate"] = {{"operator", report.estimate->kind},
                            {"cpu_seconds", number(report.estimate->cpu_seconds)},
                            {"bytes", report.estimate->bytes}};
  }
  document["cpu_seconds"] = number(report.cpu_seconds);
  document["wall_seconds"] = number(report.wall_seconds);
  document["peak_bytes"] = report.peak_bytes;
  std::string text;
  append_pretty(text, document, 0);
  return text + "\n";
}

}  // namespace luxel
