#include "form_factors/block_visibility.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "form_factors/assembly.h"
#include "form_factors/visibility_choice.h"

namespace luxel {

namespace {

// Where factors between groups are asked for, the pairs of two groups share what their factor may be off: the
// pair errors e_ij = A sqrt(G_ij G_IJ) times this add up to A G_IJ times this. Clipping's estimates are
// bounds, those of rays standard errors. Factors below least_factor may err by as much as that one.
constexpr double group_share = 0.5, group_ray_share = 0.3, least_factor = 1e-3;

// In a block that rays decide as a whole, pairs with a smaller relative tolerance are looked at one by one.
constexpr double coarse = 0.02;

// Where few pairs of a block are partly hidden, their tolerance grows, for the whole block's is theirs: up to
// this share of a pair.
constexpr double coarsest = 0.1;

// Pairs are sorted at this accuracy at least: agreement of few rays takes small shadows for none.
constexpr double loosest_sort = 5e-4;

// Pairs that exchange so many times the mean of their block are looked at by themselves.
constexpr double outstanding = 2;

}  // namespace

BlockedScene::BlockedScene(const PatchMesh& patch_mesh, const ClusterTree& cluster_tree,
                           const OccluderSet& occluders, const FormFactorOptions& factor_options,
                           const ExchangeMatrix& unhidden)
    : mesh(patch_mesh), tree(cluster_tree), set(occluders), options(factor_options) {
  ends.reserve(tree.clusters.size());
  for (const Cluster& cluster : tree.clusters) {
    ends.push_back(shaft_end(cluster.hull, cluster.centre, cluster.radius, cluster.planar));
  }
  leaf.resize(tree.patches.size());
  for (std::size_t k = 0; k < tree.clusters.size(); ++k) {
    if (tree.clusters[k].leaf()) leaf[tree.clusters[k].begin] = static_cast<int>(k);
  }
  if (options.group_accuracy) groups = GroupExchange(mesh, tree, unhidden, least_factor);
  if (options.visibility == Visibility::exact) return;
  rays.emplace(set);
  sorter.emplace(tree, *rays, options.seed);
}

void VisibilityTally::operator+=(const VisibilityTally& other) {
  hidden += other.hidden;
  partial += other.partial;
  exact += other.exact;
  sampled += other.sampled;
  rays += other.rays;
  squared_error += other.squared_error;
}

void hide_block(const ClusterTree& tree, int a, int b, ExchangeMatrix& exchange_areas,
                VisibilityTally& tally) {
  const Cluster &ca = tree.clusters[a], &cb = tree.clusters[b];
  for (int s = ca.begin; s < ca.end; ++s) {
    for (int t = cb.begin; t < cb.end; ++t) {
      const int i = tree.patches[s].patch, j = tree.patches[t].patch;
      if (exchange_areas(i, j) == 0) continue;
      exchange_areas.set(i, j, 0);
      ++tally.hidden;
    }
  }
}

BlockVisibility::BlockVisibility(const BlockedScene& scene, ExchangeMatrix& exchange_areas)
    : scene_(scene), tree_(scene.tree), exchange_(exchange_areas), clip_(scene.mesh, scene.tree, scene.set) {}

VisibilityTally BlockVisibility::operator()(const Block& block) {
  tally_ = {};
  sampled_.clear();
  descend(block.a, block.b, block.candidates);
  sample_all();
  return tally_;
}

// The block itself has been tested: its candidates are those in its shaft.
void BlockVisibility::descend(int a, int b, const std::vector<Candidate>& candidates) {
  const Cluster &ca = tree_.clusters[a], &cb = tree_.clusters[b];
  if (ca.leaf() && cb.leaf()) {
    pair(ca.begin, cb.begin, candidates);
    return;
  }
  if (sample_loose(a, b, candidates)) return;
  if (rays_decide(ca, cb, candidates.size())) {
    sort_by_rays(a, b, candidates);
    return;
  }
  const bool split_a = cb.leaf() || (!ca.leaf() && ca.size() >= cb.size());
  for (int child : split_a ? std::array{ca.left, ca.right} : std::array{cb.left, cb.right}) {
    const int x = split_a ? child : a, y = split_a ? b : child;
    if (!may_face(tree_.clusters[x], tree_.clusters[y])) continue;
    const ShaftCandidates found = candidates_in_shaft(scene_.ends[x], scene_.ends[y], scene_.set, candidates);
    if (found.hidden) {
      hide_block(tree_, x, y, exchange_, tally_);
    } else if (!found.list.empty()) {
      descend(x, y, found.list);
    }
  }
}

// Where little is asked of the pairs of a block, a few rays for each cost less than to find out what stands
// between them. Returns false, and nothing is done, where they do not.
bool BlockVisibility::sample_loose(int a, int b, const std::vector<Candidate>& candidates) {
  const Cluster &ca = tree_.clusters[a], &cb = tree_.clusters[b];
  const int side = std::max(ca.size(), cb.size());
  if (!scene_.rays || side > SightSorter::largest_side) return false;
  const double other_way = block_pair_cost(side, candidates.size());
  loose_.clear();
  double gained = 0;
  for (int s = ca.begin; s < ca.end; ++s) {
    for (int t = cb.begin; t < cb.end; ++t) {
      const double exchange = unhidden(s, t);
      if (!(exchange > 0)) continue;
      const double tolerance = allowed(s, t, exchange).rays;
      loose_.push_back({s, t, exchange, tolerance});
      if (const int rays = few_rays(tolerance / exchange)) gained += other_way - few_rays_cost(rays);
    }
    if (!(gained > 0)) return false;
  }
  for (const RayPair& pair : loose_) {
    if (few_rays(pair.tolerance / pair.unhidden) == 0) {
      look_between(pair.s, pair.t, candidates);
    } else {
      ++tally_.partial;
      sampled_.push_back(pair);
    }
  }
  return true;
}

bool BlockVisibility::rays_decide(const Cluster& a, const Cluster& b, std::size_t candidates) const {
  const int side = std::max(a.size(), b.size());
  const std::size_t few = scene_.options.visibility == Visibility::rays ? 1 : few_occluders;
  return scene_.sorter && side <= SightSorter::largest_side && rays_sort(side, candidates, few);
}

double BlockVisibility::unhidden(int s, int t) const {
  return exchange_(tree_.patches[s].patch, tree_.patches[t].patch) * tree_.scale * tree_.scale;
}

BlockVisibility::Allowed BlockVisibility::allowed(int s, int t, double exchange) const {
  const double smaller = std::min(tree_.patches[s].area, tree_.patches[t].area);
  const double in_row = scene_.options.accuracy * std::sqrt(exchange * smaller);
  Allowed allowed{pair_share * in_row, ray_share * in_row};
  if (!scene_.groups.empty()) {
    const double in_group = scene_.options.accuracy * std::sqrt(exchange * scene_.groups.at(s, t));
    allowed.clip = std::min(allowed.clip, group_share * in_group);
    allowed.rays = std::min(allowed.rays, group_ray_share * in_group);
  }
  return allowed;
}

void BlockVisibility::sort_by_rays(int a, int b, const std::vector<Candidate>& candidates) {
  const Cluster &ca = tree_.clusters[a], &cb = tree_.clusters[b];
  const std::size_t columns = static_cast<std::size_t>(cb.size());
  std::vector<double> all(static_cast<std::size_t>(ca.size()) * columns);
  double total = 0;
  int facing = 0;
  // the least that any pair's tolerance is of what its row would allow
  double strictest = 1;
  for (int s = ca.begin; s < ca.end; ++s) {
    for (int t = cb.begin; t < cb.end; ++t) {
      const double exchange = unhidden(s, t);
      all[static_cast<std::size_t>(s - ca.begin) * columns + static_cast<std::size_t>(t - cb.begin)] =
          exchange;
      if (!(exchange > 0)) continue;
      total += exchange;
      ++facing;
      const double smaller = std::min(tree_.patches[s].area, tree_.patches[t].area);
      const double in_row = ray_share * scene_.options.accuracy * std::sqrt(exchange * smaller);
      strictest = std::min(strictest, allowed(s, t, exchange).rays / in_row);
    }
  }
  if (facing == 0) return;
  std::vector<double> asked = all;
  for (double& exchange : asked) {
    if (exchange * facing > outstanding * total) exchange = 0;
  }
  const BlockSights found = scene_.sorter->sort(
      a, b, asked, strictest * ray_share * std::min(scene_.options.accuracy, loosest_sort));
  tally_.rays += found.rays;

  // of what each row and column exchanges, the part that is in doubt
  std::vector<double> rows(static_cast<std::size_t>(ca.size())), part_rows = rows, columns_sum(columns),
                                                                 part_columns(columns);
  for (std::size_t k = 0; k < all.size(); ++k) {
    rows[k / columns] += asked[k];
    columns_sum[k % columns] += asked[k];
    if (found.sights[k] != Sight::part) continue;
    part_rows[k / columns] += asked[k];
    part_columns[k % columns] += asked[k];
  }
  for (std::size_t k = 0; k < all.size(); ++k) {
    const std::size_t row = k / columns, column = k % columns;
    const int s = ca.begin + static_cast<int>(row), t = cb.begin + static_cast<int>(column);
    if (!(all[k] > 0)) continue;
    switch (found.sights[k]) {
      case Sight::whole:
        break;
      case Sight::none:
        exchange_.set(tree_.patches[s].patch, tree_.patches[t].patch, 0);
        ++tally_.hidden;
        break;
      case Sight::part: {
        double tolerance = allowed(s, t, all[k]).rays;
        if (scene_.groups.empty()) {
          const double doubt =
              std::max(part_rows[row] / rows[row], part_columns[column] / columns_sum[column]);
          tolerance = std::max(tolerance, std::min(tolerance / std::sqrt(doubt), coarsest * all[k]));
        }
        sample_or_clip(s, t, all[k], tolerance, candidates);
        break;
      }
      case Sight::unknown:
        sample_or_clip(s, t, all[k], allowed(s, t, all[k]).rays, candidates);
        break;
    }
  }
}

// A pair of a block in which rays decide, if they reach the accuracy.
void BlockVisibility::sample_or_clip(int s, int t, double exchange, double for_rays,
                                     const std::vector<Candidate>& candidates) {
  if (scene_.options.visibility == Visibility::rays || for_rays > coarse * exchange) {
    ++tally_.partial;
    sampled_.push_back({s, t, exchange, for_rays});
    return;
  }
  look_between(s, t, candidates);
}

// A pair of a block whose candidates have been found for the block as a whole.
void BlockVisibility::look_between(int s, int t, const std::vector<Candidate>& candidates) {
  const int a = scene_.leaf[s], b = scene_.leaf[t];
  const ShaftCandidates found = candidates_in_shaft(scene_.ends[a], scene_.ends[b], scene_.set, candidates);
  if (found.hidden) {
    hide_block(tree_, a, b, exchange_, tally_);
  } else if (!found.list.empty()) {
    pair(s, t, found.list);
  }
}

void BlockVisibility::pair(int s, int t, const std::vector<Candidate>& candidates) {
  const double exchange = unhidden(s, t);
  if (!(exchange > 0)) return;
  ++tally_.partial;
  const auto [for_clip, for_rays] = allowed(s, t, exchange);
  if (scene_.options.visibility == Visibility::rays ||
      (scene_.options.visibility == Visibility::automatic &&
       rays_are_cheaper(candidates.size(), for_rays / exchange))) {
    sampled_.push_back({s, t, exchange, for_rays});
    return;
  }
  const HiddenPart part = clip_(s, t, candidates, exchange, for_clip);
  ++tally_.exact;
  if (part.value > 0 || part.all) store(s, t, part.all ? 0 : exchange - part.value, part.error);
}

void BlockVisibility::sample_all() {
  if (sampled_.empty()) return;
  const RayVisibility rays(tree_, *scene_.rays, scene_.options.seed);
  const std::vector<RayShare> shares = rays.visible(sampled_);
  for (std::size_t k = 0; k < shares.size(); ++k) {
    const RayPair& pair = sampled_[k];
    store(pair.s, pair.t, pair.unhidden * shares[k].visible, pair.unhidden * shares[k].error);
    tally_.rays += shares[k].rays;
    ++tally_.sampled;
  }
}

void BlockVisibility::store(int s, int t, double visible, double error) {
  const WorkPatch &a = tree_.patches[s], &b = tree_.patches[t];
  exchange_.set(a.patch, b.patch, metres_squared(tree_, std::max(visible, 0.0)));
  tally_.squared_error += error * error * (1 / a.area + 1 / b.area);
}

}  // namespace luxel
