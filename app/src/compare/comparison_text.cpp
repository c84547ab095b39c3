#include "compare/comparison_text.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace luxel::compare {

namespace {

using Json = nlohmann::ordered_json;

constexpr double targets[] = {1e-2, 1e-4, 1e-6, 1e-8};

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

std::string short_number(double value) {
  return std::isfinite(value) ? fmt::format("{:.2e}", value) : "-";
}

Json to_json(const Run& run) {
  Json history = Json::array();
  for (const HistoryPoint& point : run.history) {
    history.push_back({point.iteration, number(point.wall_seconds), number(point.cpu_seconds),
                       number(point.relative_residual), number(point.error)});
  }
  return {{"operator", run.transport},
          {"solver", name(run.method)},
          {"accuracy", run.accuracy},
          {"patches", run.patches},
          {"right_hand_sides", run.right_hand_sides},
          {"iterations", run.iterations},
          {"converged", run.converged},
          {"stopped", run.stopped.empty() ? Json(nullptr) : Json(run.stopped)},
          {"wall_seconds", number(run.wall_seconds)},
          {"cpu_seconds", number(run.cpu_seconds)},
          {"relative_residual", number(run.relative_residual)},
          {"error", number(run.error)},
          {"error_bound", number(run.error_bound)},
          {"operator_error", number(run.operator_error)},
          {"condition_estimate", run.condition_estimate > 0 ? number(run.condition_estimate) : Json(nullptr)},
          {"message", run.message},
          {"history", std::move(history)}};
}

std::vector<Cheapest> work_precision(const Comparison& comparison) {
  std::vector<Run> all = comparison.runs;
  all.insert(all.end(), comparison.more_columns.begin(), comparison.more_columns.end());
  return cheapest_solvers(all, {std::begin(targets), std::end(targets)});
}

std::string escaped(const std::string& text) {
  std::string result;
  for (char c : text) {
    if (c == '&') {
      result += "&amp;";
    } else if (c == '<') {
      result += "&lt;";
    } else {
      result += c;
    }
  }
  return result;
}

struct Column {
  const char* title;
  std::string (*text)(const Run& run);
};

constexpr Column columns[] = {
    {"operator", [](const Run& run) { return run.transport; }},
    {"accuracy", [](const Run& run) { return fmt::format("{:g}", run.accuracy); }},
    {"patches", [](const Run& run) { return std::to_string(run.patches); }},
    {"solver", [](const Run& run) { return std::string(name(run.method)); }},
    {"iterations", [](const Run& run) { return std::to_string(run.iterations); }},
    {"CPU [s]", [](const Run& run) { return fmt::format("{:.3f}", run.cpu_seconds); }},
    {"wall [s]", [](const Run& run) { return fmt::format("{:.3f}", run.wall_seconds); }},
    {"residual", [](const Run& run) { return short_number(run.relative_residual); }},
    {"error", [](const Run& run) { return short_number(run.error); }},
    {"error bound", [](const Run& run) { return short_number(run.error_bound); }},
    {"operator error", [](const Run& run) { return short_number(run.operator_error); }},
    {"condition",
     [](const Run& run) { return run.condition_estimate > 0 ? short_number(run.condition_estimate) : "-"; }},
    {"ended", [](const Run& run) {
       return run.converged ? "converged" : run.stopped.empty() ? "-" : run.stopped;
     }}};

std::string html_row(const std::vector<std::string>& cells, const char* tag) {
  std::string row = "<tr>";
  for (const std::string& cell : cells) row += fmt::format("<{0}>{1}</{0}>", tag, escaped(cell));
  return row + "</tr>\n";
}

std::vector<std::string> cells(const Cheapest& row) {
  const bool reached = std::isfinite(row.cpu_seconds);
  return {fmt::format("{:.0e}", row.target), std::to_string(row.right_hand_sides),
          reached ? std::string(name(row.method)) : "none",
          reached ? fmt::format("{:.3f}", row.cpu_seconds) : "-"};
}

}  // namespace

std::string to_table(const Comparison& comparison) {
  std::vector<std::vector<std::string>> lines(1);
  for (const Column& column : columns) lines[0].push_back(column.title);
  for (const Run& run : comparison.runs) {
    lines.emplace_back();
    for (const Column& column : columns) lines.back().push_back(column.text(run));
  }
  std::vector<std::size_t> widths(std::size(columns));
  for (const auto& line : lines) {
    for (std::size_t k = 0; k < line.size(); ++k) widths[k] = std::max(widths[k], line[k].size());
  }
  std::string text;
  for (const auto& line : lines) {
    std::string row;
    for (std::size_t k = 0; k < line.size(); ++k) row += fmt::format("{:<{}}  ", line[k], widths[k]);
    text += row.substr(0, row.find_last_not_of(' ') + 1) + "\n";
  }
  text += fmt::format(
      "\nerrors against: {} (its own bound {})\n\ncheapest to an error of   right-hand sides   solver\n",
      comparison.reference.kind, short_number(comparison.reference.error));
  for (const Cheapest& row : work_precision(comparison)) {
    const auto cell = cells(row);
    text += fmt::format("{:<25} {:<18} {} ({} CPU s)\n", cell[0], cell[1], cell[2], cell[3]);
  }
  return text;
}

std::string to_json(const Comparison& comparison) {
  Json runs = Json::array(), more = Json::array(), cheapest = Json::array();
  for (const Run& run : comparison.runs) runs.push_back(to_json(run));
  for (const Run& run : comparison.more_columns) more.push_back(to_json(run));
  for (const Cheapest& row : work_precision(comparison)) {
    const bool reached = std::isfinite(row.cpu_seconds);
    cheapest.push_back({{"error", row.target},
                        {"right_hand_sides", row.right_hand_sides},
                        {"solver", reached ? Json(name(row.method)) : Json(nullptr)},
                        {"cpu_seconds", number(row.cpu_seconds)}});
  }
  const Json document = {
      {"scene", comparison.scene},
      {"patches", comparison.runs.empty() ? 0 : comparison.runs.front().patches},
      {"reference", {{"kind", comparison.reference.kind}, {"error", number(comparison.reference.error)}}},
      {"runs", std::move(runs)},
      {"more_right_hand_sides", std::move(more)},
      {"cheapest", std::move(cheapest)}};
  return document.dump(1) + "\n";
}

std::string to_csv(const Comparison& comparison) {
  std::string text =
      "operator,accuracy,patches,solver,right_hand_sides,iteration,wall_seconds,cpu_seconds,relative_"
      "residual,error,"
      "error_bound\n";
  const auto field = [](double value) { return std::isfinite(value) ? fmt::format("{:.9g}", value) : ""; };
  for (const auto* runs : {&comparison.runs, &comparison.more_columns}) {
    for (const Run& run : *runs) {
      for (const HistoryPoint& point : run.history) {
        text += fmt::format("{},{:g},{},{},{},{},{},{},{},{},{}\n", run.transport, run.accuracy, run.patches,
                            name(run.method), run.right_hand_sides, point.iteration,
                            field(point.wall_seconds), field(point.cpu_seconds),
                            field(point.relative_residual), field(point.error), field(point.error_bound));
      }
    }
  }
  return text;
}

std::string to_html(const Comparison& comparison, const std::string& svg) {
  std::string page = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>Solvers on {0}</title>\n"
      "<style>body{{font:15px "
      "sans-serif;margin:2em;max-width:90em}}table{{border-collapse:collapse;margin:1em 0}}"
      "td,th{{padding:.25em .8em;border-bottom:1px solid "
      "#ddd;text-align:left}}svg{{max-width:100%}}</style>\n"
      "<h1>Solvers on {0}</h1>\n<p>Errors are max |B &minus; B*| / max |B*|, against: {1} (its own bound "
      "{2}).</p>\n",
      escaped(comparison.scene), escaped(comparison.reference.kind),
      short_number(comparison.reference.error));
  page += svg.substr(std::min(svg.find("<svg"), svg.size())) + "\n<table>\n";
  std::vector<std::string> titles;
  for (const Column& column : columns) titles.emplace_back(column.title);
  page += html_row(titles, "th");
  for (const Run& run : comparison.runs) {
    std::vector<std::string> row;
    for (const Column& column : columns) row.push_back(column.text(run));
    page += html_row(row, "td");
  }
  page += "</table>\n<h2>Cheapest solver</h2>\n<table>\n";
  page += html_row({"to an error of", "right-hand sides", "solver", "CPU [s]"}, "th");
  for (const Cheapest& row : work_precision(comparison)) page += html_row(cells(row), "td");
  return page + "</table>\n</html>\n";
}

}  // namespace luxel::compare
