#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "luxel/report.h"

namespace luxel {

namespace {

// Wide enough for the longest label and a gap
constexpr std::size_t label_width = 13;

std::string number(double value, const char* format = "%.3g") {
  if (!std::isfinite(value)) return "-";
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

// 12,345,678
std::string count(std::int64_t value) {
  std::string text = std::to_string(value);
  for (int at = static_cast<int>(text.size()) - 3; at > (value < 0 ? 1 : 0); at -= 3) text.insert(at, 1, ',');
  return text;
}

std::string count(std::int64_t value, const std::string& noun) {
  return count(value) + " " + noun + (value == 1 ? "" : "s");
}

std::string bytes(std::uint64_t value) {
  constexpr std::array units = {"B", "KiB", "MiB", "GiB", "TiB"};
  double scaled = static_cast<double>(value);
  std::size_t unit = 0;
  while (scaled >= 1024 && unit + 1 < units.size()) {
    scaled /= 1024;
    ++unit;
  }
  return number(scaled, unit == 0 ? "%.0f" : "%.1f") + " " + units[unit];
}

std::string seconds(double wall, double cpu) {
  return number(wall) + " s (" + number(cpu) + " CPU s)";
}

std::string three(const std::array<double, 3>& values) {
  if (values[0] == values[1] && values[1] == values[2]) return number(values[0], "%.6g");
  return number(values[0], "%.6g") + " " + number(values[1], "%.6g") + " " + number(values[2], "%.6g");
}

class Table {
 public:
  void line(std::string label, const std::string& text) {
    label.resize(label_width, ' ');
    text_ += label + text + "\n";
  }
  std::string text() && { return std::move(text_); }

 private:
  std::string text_;
};

void add(Table& table, const Report::Operator& transport) {
  std::string text = transport.kind + ", " + bytes(transport.bytes);
  if (transport.rays > 0) text += ", " + count(transport.rays, "ray");
  table.line("operator", text + ", " + seconds(transport.wall_seconds, transport.cpu_seconds));
  text = "max " + number(transport.row_sum_error_max) + ", rms " + number(transport.row_sum_error_rms);
  if (transport.correction != "none") {
    text += "; corrected by " + transport.correction + ", at most " + number(transport.largest_correction);
  }
  table.line("row sums", text);
  if (transport.candidates.empty()) return;
  text.clear();
  for (const Report::Operator::Candidate& each : transport.candidates) {
    text += (text.empty() ? "" : "; ") + each.kind + " about " + number(each.cpu_seconds, "%.2g") +
            " CPU s, " + bytes(each.bytes) + (each.fits ? "" : ": does not fit");
  }
  table.line("chosen of", text);
}

void add(Table& table, const Report::Solver& solver) {
  table.line("solver", solver.method + ": " + (solver.converged ? "converged in " : "not converged after ") +
                           count(solver.iterations, "iteration") + ", " +
                           seconds(solver.wall_seconds, solver.cpu_seconds));
  table.line("", "relative residual " + number(solver.relative_residual) + ", error bound " +
                     number(solver.error_bound));
  if (!solver.message.empty()) table.line("", solver.message);
}

void add(Table& table, const Report::Energy& energy) {
  table.line("energy [W]", "emitted " + three(energy.emitted) + "; absorbed " + three(energy.absorbed) +
                               "; escaped " + three(energy.escaped) + "; imbalance " +
                               number(energy.imbalance));
}

void add(Table& table, const Report::Error& error) {
  std::string range;
  if (std::isfinite(error.operator_low) && std::isfinite(error.operator_high)) {
    range = " (" + number(error.operator_low) + " to " + number(error.operator_high) + ")";
  }
  table.line("error", "algebraic " + number(error.algebraic) + ", operator " +
                          number(error.operator_estimate) + range + ", discretisation " +
                          number(error.discretisation));
}

}  // namespace

std::string summary(const Report& report) {
  Table table;
  const Report::Scene& scene = report.scene;
  table.line("scene", scene.file);
  table.line("", count(scene.faces, "face") + ", " + count(scene.vertices) +
                     (scene.vertices == 1 ? " vertex" : " vertices") + ", " +
                     count(scene.materials, "material") + ", " + number(scene.area, "%.6g") + " m2, " +
                     (scene.closed ? "closed" : "open") + ", " + count(scene.enclosures, "enclosure"));
  if (scene.overlapping_faces > 0) {
    table.line("overlaps", count(scene.overlapping_faces, "face") + ", " +
                               number(scene.overlap_area, "%.6g") +
                               " m2 covered by earlier faces on the same side");
  }
  table.line("patches", count(report.patches));
  if (report.partial) table.line("PARTIAL", "stopped before it was solved; files hold what was there");
  if (report.transport) add(table, *report.transport);
  if (report.solver) add(table, *report.solver);
  if (report.energy) add(table, *report.energy);
  if (report.error) add(table, *report.error);
  for (const Report::LeftOut& item : report.left_out) {
    table.line("left out",
               item.what + ": " + item.why + (item.saved.empty() ? "" : " (saved " + item.saved + ")"));
  }
  if (report.estimate) {
    table.line("to solve", report.estimate->kind + ", about " + number(report.estimate->cpu_seconds, "%.2g") +
                               " CPU s, " + bytes(report.estimate->bytes));
  }
  table.line("run", seconds(report.wall_seconds, report.cpu_seconds) + ", " +
                        count(report.run.threads, "thread") + ", peak memory " + bytes(report.peak_bytes));
  for (const std::string& warning : scene.warnings) table.line("warning", warning);
  return std::move(table).text();
}

}  // namespace luxel
