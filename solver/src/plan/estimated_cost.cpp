#include <algorithm>
#include <cmath>
#include <cstdint>

#include "form_factors/cluster_tree.h"
#include "form_factors/occluder_set.h"
#include "form_factors/shaft.h"
#include "luxel/plan.h"
#include "plan/cost_model.h"

namespace luxel {

namespace {

// Shares of pairs are drawn from so many, fewer where there are many occluders to look at: a tenth of a
// second.
constexpr int most_draws = 2000;
constexpr int least_draws = 100;
constexpr double most_looks = 2e6;

/// What happens to the pairs of a system's patches.
struct PairShares {
  double facing = 0;   ///< may see each other
  double partial = 0;  ///< and something may stand between them
  double crowded = 0;  ///< of the partial ones, those that are left to rays
};

/// A fixed sequence of numbers below `size` (Knuth's MMIX congruence).
class Draws {
 public:
  int below(int size) {
    state_ = state_ * 6364136223846793005ull + 1442695040888963407ull;
    return static_cast<int>((state_ >> 33) % static_cast<std::uint64_t>(size));
  }

 private:
  std::uint64_t state_ = 1;
};

PairShares pair_shares(const PatchMesh& mesh, bool hides, bool keep_idle) {
  const ClusterTree tree = cluster_tree(mesh);
  OccluderSet set;
  if (hides) set = occluder_set(mesh, tree, keep_idle);
  std::vector<const Cluster*> leaves;
  for (const Cluster& cluster : tree.clusters) {
    if (cluster.leaf()) leaves.push_back(&cluster);
  }
  const std::vector<Candidate> all = all_candidates(set);
  const double looks = most_looks / std::max<std::size_t>(set.faces.size(), 1);
  const int draws = static_cast<int>(std::clamp<double>(looks, least_draws, most_draws));
  Draws random;
  PairShares shares;
  for (int k = 0; k < draws; ++k) {
    const Cluster& a = *leaves[random.below(mesh.size())];
    const Cluster& b = *leaves[random.below(mesh.size())];
    if (!may_face(a, b)) continue;
    shares.facing += 1.0 / draws;
    if (set.occluders.empty()) continue;
    const ShaftEnd from = shaft_end(a.hull, a.centre, a.radius), to = shaft_end(b.hull, b.centre, b.radius);
    const ShaftCandidates between = candidates_in_shaft(from, to, set, all);
    if (between.hidden || between.list.empty()) continue;
    shares.partial += 1.0 / draws;
    if (between.list.size() > few_occluders) shares.crowded += 1.0 / draws;
  }
  return shares;
}

SolveShape shape(const SystemPlan& system, const PatchMesh& part, const PatchField& rho,
                 const SolveOptions& options) {
  SolveShape shape;
  shape.patches = part.size();
  const Eigen::Map<const Eigen::VectorXd> areas(part.areas.data(), part.size());
  std::vector<int> firsts;
  for (const int c : system.channels.solved) {
    shape.largest_reflectance = std::max(shape.largest_reflectance, rho.col(c).maxCoeff());
    shape.mean_reflectance = std::max(shape.mean_reflectance, areas.dot(rho.col(c)) / areas.sum());
    const auto same =
        std::find_if(firsts.begin(), firsts.end(), [&](int f) { return rho.col(f) == rho.col(c); });
    if (same == firsts.end()) {
      firsts.push_back(c);
      shape.columns.push_back(1);
    } else {
      ++shape.columns[same - firsts.begin()];
    }
  }
  shape.tolerance = std::min(options.error.value_or(options.tolerance), 0.5);
  shape.precision = system.precision;
  return shape;
}

}  // namespace

double planned_bytes(const Plan& plan) {
  double largest = 0;
  for (const SystemPlan& system : plan.systems) {
    const double n = static_cast<double>(system.patches.size());
    largest = std::max(largest, operator_bytes(n, system.precision) + factor_bytes(n, system.method));
  }
  return mesh_bytes(plan.patches) + largest;
}

Cost estimated_cost(const Plan& plan, const PatchMesh& mesh, const Enclosures& enclosures,
                    const PlanOptions& options) {
  Cost cost;
  cost.cpu_seconds = mesh_seconds(mesh.size()) + enclosure_seconds(enclosures.rays);
  for (const SystemPlan& system : plan.systems) {
    const PatchMesh part = sub_mesh(mesh, system.patches, system.closed);
    const PairShares shares = pair_shares(part, system.hiding_polygons > 0, plan.keep_idle_occluders);
    const double n = part.size(), pairs = n * (n - 1) / 2, accuracy = options.form_factors.accuracy;
    const SolveShape solved = shape(system, part, reflectance(part), options.solve);
    Method method = system.method;
    if (options.solve.bounces) method = Method::neumann;
    if (method == Method::automatic) method = cheapest_method(solved);
    cost.cpu_seconds += assembly_seconds(pairs * shares.facing, accuracy);
    cost.cpu_seconds += visibility_seconds(pairs * (shares.partial - shares.crowded), pairs * shares.crowded);
    cost.cpu_seconds += closure_seconds(n, system.precision, system.closed) + solve_seconds(method, solved);
  }
  cost.bytes = planned_bytes(plan);
  return cost;
}

}  // namespace luxel
