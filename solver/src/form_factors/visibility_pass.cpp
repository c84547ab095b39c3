#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <optional>
#include <vector>

#include "form_factors/assembly.h"
#include "form_factors/group_exchange.h"
#include "form_factors/hidden_pair.h"
#include "form_factors/occluder_set.h"
#include "form_factors/ray_visibility.h"
#include "form_factors/shaft.h"
#include "luxel/input_error.h"

namespace luxel {

namespace {

// Errors of single pairs have either sign; rows of n pairs, each with A sqrt(G_ij min(A_i, A_j)) times this,
// err by A times this in the root mean square.
constexpr double pair_share = 0.3;

// Rays err independently, clipping does not: their share is larger, such that the largest of 10,000 rows
// (four standard deviations) stays below 2 A.
constexpr double ray_share = 0.7;

// Where factors between groups are asked for, the pairs of two groups share what their factor may be off: the
// pair errors e_ij = A sqrt(G_ij G_IJ) times this add up to A G_IJ times this. Clipping's estimates are
// bounds, those of rays standard errors. Factors below least_factor may err by as much as that one.
constexpr double group_share = 0.5, group_ray_share = 0.3, least_factor = 1e-3;

// Up to so many occluders between a pair, clipping is always the cheaper way.
constexpr std::size_t few_occluders = 6;

// Costs [us], measured: a pair clipped against k occluders takes clip_cost + clip_growth k^2, a ray ray_cost;
// rays for a relative tolerance t are about (ray_need / t)^(1 / 0.7).
constexpr double clip_cost = 3, clip_growth = 0.3, ray_cost = 0.06, ray_need = 0.4;

// In a block that rays decide as a whole, pairs with a smaller relative tolerance are looked at one by one.
constexpr double coarse = 0.02;

// Blocks of so many patches a side, or fewer, are handed to rays as a whole.
constexpr int ray_block = 16;

// The list of block pairs is cut until a block has at most this many entries, so that there are enough blocks
// for any number of threads and few enough to keep their lists of candidates.
constexpr std::int64_t block_entries = 64 * 64;

// Progress is told about so often.
constexpr std::size_t reports = 200;

// One block of the matrix with the occluders that may matter in it.
struct Block {
  int a, b;
  std::vector<Candidate> candidates;
};

// What one block found; summed in the order of the blocks.
struct Tally {
  std::int64_t hidden = 0, partial = 0, exact = 0, sampled = 0, rays = 0;
  double squared_error = 0;  ///< sum of e^2 (1 / A_i + 1 / A_j)

  void operator+=(const Tally& other) {
    hidden += other.hidden;
    partial += other.partial;
    exact += other.exact;
    sampled += other.sampled;
    rays += other.rays;
    squared_error += other.squared_error;
  }
};

class VisibilityPass {
 public:
  VisibilityPass(const PatchMesh& mesh, const ClusterTree& tree, const OccluderSet& set,
                 const FormFactorOptions& options, ExchangeMatrix& exchange_areas)
      : mesh_(mesh), tree_(tree), set_(set), options_(options), exchange_(exchange_areas) {
    ends_.reserve(tree.clusters.size());
    for (const Cluster& cluster : tree.clusters) {
      ends_.push_back(shaft_end(cluster.hull, cluster.centre, cluster.radius, cluster.planar));
    }
    leaf_.resize(tree.patches.size());
    for (std::size_t k = 0; k < tree.clusters.size(); ++k) {
      if (tree.clusters[k].leaf()) leaf_[tree.clusters[k].begin] = static_cast<int>(k);
    }
    if (options.group_accuracy) groups_ = GroupExchange(mesh, tree, exchange_areas, least_factor);
    if (options.visibility != Visibility::exact) rays_.emplace(tree, set, options.seed);
  }

  Tally run(const Progress& progress) {
    std::vector<Block> blocks;
    Tally total;
    const auto n = static_cast<std::int64_t>(tree_.patches.size());
    limit_ = std::max<std::int64_t>(block_entries, n * n / 8192);
    split(tree_.root, tree_.root, all_candidates(set_), blocks, total);
    std::vector<Tally> tallies(blocks.size());
    tbb::enumerable_thread_specific<HiddenPair> clippers([&] { return HiddenPair(mesh_, tree_, set_); });
    std::mutex mutex;
    std::size_t done = 0;
    const std::size_t step = std::max<std::size_t>(1, blocks.size() / reports);
    tbb::task_group_context context;
    bool cancelled = false;
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, blocks.size(), 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t k = range.begin(); k < range.end(); ++k) {
            tallies[k] = run_block(blocks[k], clippers.local());
            if (!progress) continue;
            const std::lock_guard lock(mutex);
            if (++done % step == 0 && !cancelled &&
                !progress("visibility", static_cast<double>(done), static_cast<double>(blocks.size()))) {
              cancelled = true;
              context.cancel_group_execution();
            }
          }
        },
        tbb::simple_partitioner(), context);
    if (cancelled) throw Cancelled();
    for (const Tally& tally : tallies) total += tally;
    return total;
  }

 private:
  struct BlockWork {
    Tally tally;
    std::vector<RayPair> rays;
  };

  std::int64_t entries(int a, int b) const {
    return static_cast<std::int64_t>(tree_.clusters[a].size()) * tree_.clusters[b].size();
  }

  // Descends from a pair of clusters, the same one twice included, to blocks of at most limit_ entries.
  void split(int a, int b, const std::vector<Candidate>& inherited, std::vector<Block>& blocks,
             Tally& tally) {
    const Cluster &ca = tree_.clusters[a], &cb = tree_.clusters[b];
    if (a == b) {
      if (ca.leaf() || ca.planar) return;
      split(ca.left, ca.left, inherited, blocks, tally);
      split(ca.right, ca.right, inherited, blocks, tally);
      split(ca.left, ca.right, inherited, blocks, tally);
      return;
    }
    if (!may_face(ca, cb)) return;
    ShaftCandidates found = candidates_in_shaft(ends_[a], ends_[b], set_, inherited);
    if (found.hidden) {
      hide(a, b, tally);
    } else if (!found.list.empty()) {
      if (entries(a, b) <= limit_ || (ca.leaf() && cb.leaf())) {
        blocks.push_back({a, b, std::move(found.list)});
      } else if (cb.leaf() || (!ca.leaf() && ca.size() >= cb.size())) {
        split(ca.left, b, found.list, blocks, tally);
        split(ca.right, b, found.list, blocks, tally);
      } else {
        split(a, cb.left, found.list, blocks, tally);
        split(a, cb.right, found.list, blocks, tally);
      }
    }
  }

  void hide(int a, int b, Tally& tally) {
    const Cluster &ca = tree_.clusters[a], &cb = tree_.clusters[b];
    for (int s = ca.begin; s < ca.end; ++s) {
      for (int t = cb.begin; t < cb.end; ++t) {
        const int i = tree_.patches[s].patch, j = tree_.patches[t].patch;
        if (exchange_(i, j) == 0) continue;
        exchange_.set(i, j, 0);
        ++tally.hidden;
      }
    }
  }

  Tally run_block(const Block& block, HiddenPair& clip) {
    BlockWork work;
    descend(block.a, block.b, block.candidates, clip, work);
    if (!work.rays.empty()) {
      const std::vector<RayShare> shares = rays_->visible(work.rays);
      for (std::size_t k = 0; k < shares.size(); ++k) {
        const RayPair& pair = work.rays[k];
        store(pair.s, pair.t, pair.unhidden * shares[k].visible, pair.unhidden * shares[k].error, work.tally);
        work.tally.rays += shares[k].rays;
        ++work.tally.sampled;
      }
    }
    return work.tally;
  }

  // The block itself has been tested: its candidates are those in its shaft.
  void descend(int a, int b, const std::vector<Candidate>& candidates, HiddenPair& clip, BlockWork& work) {
    const Cluster &ca = tree_.clusters[a], &cb = tree_.clusters[b];
    if (ca.leaf() && cb.leaf()) {
      pair(ca.begin, cb.begin, candidates, clip, work);
      return;
    }
    if (rays_decide(ca, cb, candidates)) {
      for (int s = ca.begin; s < ca.end; ++s) {
        for (int t = cb.begin; t < cb.end; ++t) sample_or_clip(s, t, candidates, clip, work);
      }
      return;
    }
    const bool split_a = cb.leaf() || (!ca.leaf() && ca.size() >= cb.size());
    for (int child : split_a ? std::array{ca.left, ca.right} : std::array{cb.left, cb.right}) {
      const int x = split_a ? child : a, y = split_a ? b : child;
      if (!may_face(tree_.clusters[x], tree_.clusters[y])) continue;
      const ShaftCandidates found = candidates_in_shaft(ends_[x], ends_[y], set_, candidates);
      if (found.hidden) {
        hide(x, y, work.tally);
      } else if (!found.list.empty()) {
        descend(x, y, found.list, clip, work);
      }
    }
  }

  // Where many small occluders stand in the way of a small block, tests of single pairs cost more than rays.
  bool rays_decide(const Cluster& a, const Cluster& b, const std::vector<Candidate>& candidates) const {
    return options_.visibility != Visibility::exact && a.size() <= ray_block && b.size() <= ray_block &&
           candidates.size() > (options_.visibility == Visibility::rays ? 1 : few_occluders);
  }

  double unhidden(int s, int t) const {
    return exchange_(tree_.patches[s].patch, tree_.patches[t].patch) * tree_.scale * tree_.scale;
  }

  // What the visible part of a pair may be off, by clipping and by rays; working units.
  struct Allowed {
    double clip, rays;
  };
  Allowed allowed(int s, int t, double exchange) const {
    const double smaller = std::min(tree_.patches[s].area, tree_.patches[t].area);
    const double in_row = options_.accuracy * std::sqrt(exchange * smaller);
    Allowed allowed{pair_share * in_row, ray_share * in_row};
    if (!groups_.empty()) {
      const double in_group = options_.accuracy * std::sqrt(exchange * groups_.at(s, t));
      allowed.clip = std::min(allowed.clip, group_share * in_group);
      allowed.rays = std::min(allowed.rays, group_ray_share * in_group);
    }
    return allowed;
  }

  // A pair of a block in which rays decide, if they reach the accuracy.
  void sample_or_clip(int s, int t, const std::vector<Candidate>& candidates, HiddenPair& clip,
                      BlockWork& work) {
    const double exchange = unhidden(s, t);
    if (!(exchange > 0)) return;
    const double for_rays = allowed(s, t, exchange).rays;
    if (options_.visibility == Visibility::rays || for_rays > coarse * exchange) {
      ++work.tally.partial;
      work.rays.push_back({s, t, exchange, for_rays});
      return;
    }
    const int a = leaf_[s], b = leaf_[t];
    const ShaftCandidates found = candidates_in_shaft(ends_[a], ends_[b], set_, candidates);
    if (found.hidden) {
      hide(a, b, work.tally);
    } else if (!found.list.empty()) {
      pair(s, t, found.list, clip, work);
    }
  }

  static bool rays_are_cheaper(std::size_t occluders, double relative_tolerance) {
    if (occluders <= few_occluders) return false;
    const double k = static_cast<double>(occluders);
    return ray_cost * std::pow(ray_need / relative_tolerance, 1 / 0.7) < clip_cost + clip_growth * k * k;
  }

  void pair(int s, int t, const std::vector<Candidate>& candidates, HiddenPair& clip, BlockWork& work) {
    const double exchange = unhidden(s, t);
    if (!(exchange > 0)) return;
    ++work.tally.partial;
    const auto [for_clip, for_rays] = allowed(s, t, exchange);
    if (options_.visibility == Visibility::rays ||
        (options_.visibility == Visibility::automatic &&
         rays_are_cheaper(candidates.size(), for_rays / exchange))) {
      work.rays.push_back({s, t, exchange, for_rays});
      return;
    }
    const HiddenPart part = clip(s, t, candidates, exchange, for_clip);
    ++work.tally.exact;
    if (part.value > 0 || part.all) store(s, t, part.all ? 0 : exchange - part.value, part.error, work.tally);
  }

  void store(int s, int t, double visible, double error, Tally& tally) {
    const WorkPatch &a = tree_.patches[s], &b = tree_.patches[t];
    exchange_.set(a.patch, b.patch, metres_squared(tree_, std::max(visible, 0.0)));
    tally.squared_error += error * error * (1 / a.area + 1 / b.area);
  }

  const PatchMesh& mesh_;
  const ClusterTree& tree_;
  const OccluderSet& set_;
  const FormFactorOptions& options_;
  ExchangeMatrix& exchange_;
  GroupExchange groups_;
  std::vector<ShaftEnd> ends_;
  std::vector<int> leaf_;  // of each patch its cluster
  std::optional<RayVisibility> rays_;
  std::int64_t limit_ = block_entries;
};

}  // namespace

void subtract_hidden(const PatchMesh& mesh, const ClusterTree& tree, const FormFactorOptions& options,
                     ExchangeMatrix& exchange_areas, FormFactorReport& report, const Progress& progress) {
  const OccluderSet set = occluder_set(mesh, tree, options.keep_idle_occluders);
  for (const Occluder& occluder : set.occluders) report.occluders += occluder.face_count();
  if (set.occluders.empty()) return;
  const Tally tally = VisibilityPass(mesh, tree, set, options, exchange_areas).run(progress);
  report.hidden_pairs = tally.hidden;
  report.partial_pairs = tally.partial;
  report.exact_pairs = tally.exact;
  report.sampled_pairs = tally.sampled;
  report.rays = tally.rays;
  double total = 0;
  for (const WorkPatch& patch : tree.patches) total += patch.area;
  // rows err by sqrt(sum_j e_ij^2) / A_i; their mean square is weighted by area
  report.estimated_error =
      std::sqrt(report.estimated_error * report.estimated_error + tally.squared_error / total);
}

}  // namespace luxel
