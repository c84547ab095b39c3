#include "factor_tables.h"

#include <algorithm>

#include <fmt/format.h>

namespace luxel::app {

namespace {

constexpr std::size_t number_width = 13;  // "0.1998248957 " and "1.234567e-12 "

std::size_t name_width(const std::vector<std::string>& names) {
  std::size_t width = 4;
  for (const std::string& name : names) width = std::max(width, name.size());
  return width;
}

std::string groups_table(const Report::GroupFactors& factors) {
  const std::size_t width = name_width(factors.groups);
  const std::size_t column = std::max(width + 1, number_width);
  std::string text = fmt::format("\n{:<{}} {:>{}}", "F", width, "area [m2]", column);
  for (const std::string& name : factors.groups) text += fmt::format("{:>{}}", name, column);
  text += fmt::format("{:>{}}\n", "open", column);
  for (std::size_t i = 0; i < factors.groups.size(); ++i) {
    text += fmt::format("{:<{}} {:>{}.7g}", factors.groups[i], width, factors.areas[i], column);
    for (const double f : factors.form_factors[i]) text += fmt::format("{:>{}.7g}", f, column);
    text += fmt::format("{:>{}.3g}\n", factors.open[i], column);
  }
  return text;
}

std::string point_table(const Report::PointFactors& from) {
  std::string text =
      fmt::format("\nfrom ({:g}, {:g}, {:g}) with normal ({:g}, {:g}, {:g}), {}\n", from.point[0],
                  from.point[1], from.point[2], from.normal[0], from.normal[1], from.normal[2],
                  from.error > 0 ? fmt::format("standard error {:.1g}", from.error) : "exact");
  const std::size_t width = name_width(from.groups);
  for (std::size_t i = 0; i < from.groups.size(); ++i) {
    text += fmt::format("{:<{}} {:>{}.7g}\n", from.groups[i], width, from.form_factors[i], number_width);
  }
  return text + fmt::format("{:<{}} {:>{}.7g}\n", "open", width, from.open, number_width);
}

}  // namespace

std::string factor_tables(const Report& report) {
  std::string text;
  if (report.group_factors) text += groups_table(*report.group_factors);
  if (report.point_factors) text += point_table(*report.point_factors);
  return text;
}

}  // namespace luxel::app
