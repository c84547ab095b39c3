#include <array>
#include <utility>

#include "luxel/solve.h"

namespace luxel {

namespace {

constexpr std::array<std::pair<Method, std::string_view>, 9> names{{
    {Method::automatic, "auto"},
    {Method::cholesky, "cholesky"},
    {Method::lu, "lu"},
    {Method::cg, "cg"},
    {Method::gmres, "gmres"},
    {Method::neumann, "neumann"},
    {Method::gauss_seidel, "gauss-seidel"},
    {Method::symmetric_gauss_seidel, "symmetric-gauss-seidel"},
    {Method::southwell, "southwell"},
}};

}  // namespace

std::string_view name(Method method) {
  for (const auto& [value, word] : names) {
    if (value == method) return word;
  }
  return "unknown";
}

std::optional<Method> method_from_name(std::string_view name) {
  if (name == "jacobi") return Method::neumann;
  for (const auto& [value, word] : names) {
    if (word == name) return value;
  }
  return std::nullopt;
}

}  // namespace luxel
