#include <algorithm>
#include <utility>
#include <vector>

#include "luxel/hierarchical_operator.h"

namespace luxel {

namespace {

// Of the operator's error: what the iteration may leave.
constexpr double tolerance_share = 0.01;

// Whether each finish has one row of the field all over.
bool equal_on_finishes(const PatchMesh& mesh, const PatchField& field) {
  std::vector<int> first(mesh.finish_table.size(), -1);
  for (int p = 0; p < mesh.size(); ++p) {
    const auto finish = static_cast<std::size_t>(mesh.finishes[p]);
    if (finish >= first.size()) first.resize(finish + 1, -1);
    if (first[finish] < 0) first[finish] = p;
    if (field.row(p) != field.row(first[finish])) return false;
  }
  return true;
}

}  // namespace

HierarchicalSolution solve_hierarchical(const PatchMesh& mesh, const Enclosures& enclosures,
                                        const PatchField& reflectance, const PatchField& emission,
                                        const HierarchicalOptions& options, const SolveOptions& solving,
                                        const Progress& progress) {
  HierarchicalSolution solution;
  solution.transport = hierarchical_operator(mesh, enclosures, reflectance, emission, options, progress);
  const HierarchicalOperator& transport = *solution.transport;
  SolveOptions iteration = solving;
  iteration.tolerance = std::max(solving.tolerance, tolerance_share * options.accuracy);
  if (!equal_on_finishes(mesh, reflectance) || !equal_on_finishes(mesh, emission)) {
    solution.light = solve(transport, reflectance, emission, iteration);
    return solution;
  }
  if (solving.on_iteration) {
    iteration.on_iteration = [&](const Iteration& step) {
      Iteration without_field = step;
      without_field.radiosity = nullptr;
      return solving.on_iteration(without_field);
    };
  }
  // means of equal numbers, up to rounding
  const PatchField rho = transport.restrict(reflectance).cwiseMax(0).cwiseMin(1);
  const PatchField source = transport.restrict(emission).cwiseMax(0);
  RadiositySolution nodes = solve(transport.coarse(), rho, source, iteration);
  solution.light.report = std::move(nodes.report);
  // interpolation may overshoot where light falls to nothing
  solution.light.irradiance = transport.expand(nodes.irradiance).cwiseMax(0);
  solution.light.radiosity = emission + reflectance.cwiseProduct(solution.light.irradiance);
  return solution;
}

}  // namespace luxel
