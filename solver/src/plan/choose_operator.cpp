#include <algorithm>

#include "luxel/plan.h"
#include "plan/decisions.h"

namespace luxel {

namespace {

// What is given for a symmetric operator with entries: these seconds, or so many times the time of the
// fastest.
constexpr double dense_is_worth = 2, dense_seconds = 10;

// Beyond so many patches dense is estimated by the least that it can take, without looking at pairs.
constexpr int few_patches = 50'000;

// The least that pairs cost: a third of them face each other, and nothing is hidden [s a pair].
constexpr double least_pair_seconds = 4e-9;

/// All patches as one system, whose enclosures nobody has looked for.
Cost dense_cost(const PatchMesh& mesh, const PlanOptions& options) {
  if (mesh.size() > few_patches) {
    const double n = mesh.size(), pairs = n * (n - 1) / 2;
    return {least_pair_seconds * pairs, 4 * pairs};
  }
  const Enclosures one = one_closed_enclosure(mesh.size());
  return estimated_cost(make_plan(mesh, one, options), mesh, one, options);
}

}  // namespace

std::string_view name(OperatorKind kind) {
  switch (kind) {
    case OperatorKind::dense:
      return "dense";
    case OperatorKind::gather:
      return "gather";
    case OperatorKind::hierarchical:
      return "hierarchical";
    default:
      return "auto";
  }
}

std::optional<OperatorKind> operator_from_name(std::string_view text) {
  for (const auto kind :
       {OperatorKind::automatic, OperatorKind::dense, OperatorKind::gather, OperatorKind::hierarchical}) {
    if (text == name(kind)) return kind;
  }
  return std::nullopt;
}

OperatorChoice choose_operator(const PatchMesh& mesh, const PlanOptions& options, double most_bytes) {
  OperatorChoice choice;
  choice.estimates = {{OperatorKind::dense, dense_cost(mesh, options)}};
  if (options.form_factors.accuracy >= finest_sampled) {
    choice.estimates.push_back({OperatorKind::gather, estimated_gather_cost(mesh, options)});
    choice.estimates.push_back({OperatorKind::hierarchical, estimated_hierarchical_cost(mesh, options)});
  }
  const OperatorEstimate* best = nullptr;
  const auto better = [](const OperatorEstimate& a, const OperatorEstimate& b) {
    if (a.fits != b.fits) return a.fits;
    if (!a.fits) return a.cost.bytes < b.cost.bytes;
    return a.cost.cpu_seconds < b.cost.cpu_seconds;
  };
  for (OperatorEstimate& estimate : choice.estimates) {
    estimate.fits = estimate.cost.bytes <= most_bytes;
    if (!best || better(estimate, *best)) best = &estimate;
  }
  const OperatorEstimate& dense = choice.estimates.front();
  const double worth = std::max(dense_seconds, dense_is_worth * best->cost.cpu_seconds);
  choice.kind = dense.fits && dense.cost.cpu_seconds <= worth ? OperatorKind::dense : best->kind;
  return choice;
}

}  // namespace luxel
