#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "form_factors/block_sights.h"
#include "form_factors/cluster_tree.h"
#include "form_factors/occluder_set.h"
#include "form_factors/shaft.h"
#include "form_factors/sky_box.h"
#include "form_factors/visibility_choice.h"
#include "luxel/plan.h"
#include "ordered_sum.h"
#include "plan/cost_model.h"

namespace luxel {

namespace {

// Shares of pairs are drawn from so many, fewer where there are many occluders to look at: a tenth of a
// second.
constexpr int most_draws = 2000;
constexpr int least_draws = 100;
constexpr double most_looks = 2e6;

// Kernels of pairs that nearly look along each other's planes, times an area: far below what any accuracy
// asks.
constexpr double least_kernel = 1e-30;

/// What happens to the pairs of a system's patches.
struct PairShares {
  double facing = 0;              ///< may see each other
  double visibility_seconds = 0;  ///< CPU time of what hides them, a pair of all
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

ShaftEnd end_of(const Cluster& cluster) {
  return shaft_end(cluster.hull, cluster.centre, cluster.radius, cluster.planar);
}

/// Of each patch of a tree its own cluster, and the largest around it whose pairs rays may take as a whole.
struct ClustersOfPatches {
  std::vector<int> leaf, block;
};

ClustersOfPatches clusters_of_patches(const ClusterTree& tree) {
  ClustersOfPatches of{std::vector<int>(tree.patches.size()), std::vector<int>(tree.patches.size(), -1)};
  std::vector<int> open{tree.root};
  while (!open.empty()) {
    const int k = open.back();
    open.pop_back();
    const Cluster& cluster = tree.clusters[k];
    if (cluster.size() <= SightSorter::largest_side && of.block[cluster.begin] < 0) {
      std::fill(of.block.begin() + cluster.begin, of.block.begin() + cluster.end, k);
    }
    if (cluster.leaf()) {
      of.leaf[cluster.begin] = k;
    } else {
      open.push_back(cluster.left);
      open.push_back(cluster.right);
    }
  }
  return of;
}

/// What rays may leave of error in a pair, relative to what it exchanges, as if both ends were points.
double relative_tolerance(const WorkPatch& a, const WorkPatch& b, double accuracy) {
  const Vec3 sight = b.centroid - a.centroid;
  const double squared = sight.squaredNorm();
  const double kernel = std::abs(sight.dot(a.plane.normal) * sight.dot(b.plane.normal)) / (squared * squared);
  const double larger = std::max(a.area, b.area);
  return ray_share * accuracy / std::sqrt(std::max(kernel * larger / std::numbers::pi, least_kernel));
}

double clipping(const std::vector<Candidate>& candidates, const OccluderSet& set) {
  double flat = 0, of_bodies = 0;
  for (const Candidate& candidate : candidates) {
    if (set.occluders[candidate.occluder].body()) {
      of_bodies += std::popcount(candidate.from_a);
    } else {
      ++flat;
    }
  }
  return clipped_pair_seconds(flat, of_bodies);
}

PairShares pair_shares(const PatchMesh& mesh, bool hides, bool keep_idle, double accuracy) {
  const ClusterTree tree = cluster_tree(mesh);
  OccluderSet set;
  if (hides) set = occluder_set(mesh, tree, keep_idle);
  const ClustersOfPatches of = clusters_of_patches(tree);
  const std::vector<Candidate> all = all_candidates(set);
  const double looks = most_looks / std::max<std::size_t>(set.faces.size(), 1);
  const int draws = static_cast<int>(std::clamp<double>(looks, least_draws, most_draws));
  Draws random;
  PairShares shares;
  for (int k = 0; k < draws; ++k) {
    const int s = random.below(mesh.size()), t = random.below(mesh.size());
    const Cluster &a = tree.clusters[of.leaf[s]], &b = tree.clusters[of.leaf[t]];
    if (!may_face(a, b)) continue;
    shares.facing += 1.0 / draws;
    if (set.occluders.empty()) continue;
    const Cluster &around_a = tree.clusters[of.block[s]], &around_b = tree.clusters[of.block[t]];
    const ShaftCandidates around = candidates_in_shaft(end_of(around_a), end_of(around_b), set, all);
    if (around.hidden || around.list.empty()) continue;
    const int side = std::max(around_a.size(), around_b.size());
    const int rays = few_rays(relative_tolerance(tree.patches[s], tree.patches[t], accuracy));
    double seconds = 0;
    if (rays > 0 && few_rays_cost(rays) < block_pair_cost(side, around.list.size())) {
      seconds = few_rays_seconds(rays, static_cast<double>(set.faces.size()));
    } else if (rays_sort(side, around.list.size())) {
      seconds = sorted_pair_seconds();
    } else {
      const ShaftCandidates between = candidates_in_shaft(end_of(a), end_of(b), set, around.list);
      if (between.hidden || between.list.empty()) continue;
      seconds = between.list.size() > few_occluders ? crowded_pair_seconds() : clipping(between.list, set);
    }
    shares.visibility_seconds += seconds / draws;
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
    shape.mean_reflectance =
        std::max(shape.mean_reflectance, areas.dot(rho.col(c)) / ordered_sum(part.areas));
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
    const double n = part.size(), pairs = n * (n - 1) / 2, accuracy = options.form_factors.accuracy;
    const PairShares shares =
        pair_shares(part, system.hiding_polygons > 0, plan.keep_idle_occluders, accuracy);
    const SolveShape solved = shape(system, part, reflectance(part), options.solve);
    Method method = system.method;
    if (options.solve.bounces) method = Method::neumann;
    if (method == Method::automatic) method = cheapest_method(solved);
    cost.cpu_seconds += assembly_seconds(pairs * shares.facing, accuracy);
    cost.cpu_seconds += pairs * shares.visibility_seconds;
    if (!system.closed) cost.cpu_seconds += sky_seconds(n * sky_quads(part.size()), accuracy);
    cost.cpu_seconds += closure_seconds(n, system.precision, system.closed) + solve_seconds(method, solved);
  }
  cost.bytes = planned_bytes(plan);
  return cost;
}

}  // namespace luxel
