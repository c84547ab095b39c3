#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <vector>

#include "form_factors/assembly.h"
#include "form_factors/block_visibility.h"
#include "form_factors/occluder_set.h"
#include "form_factors/shaft.h"
#include "luxel/input_error.h"

namespace luxel {

namespace {

// The list of block pairs is cut until a block has at most this many entries, so that there are enough blocks
// for any number of threads and few enough to keep their lists of candidates.
constexpr std::int64_t block_entries = 64 * 64;

// Progress is told about so often.
constexpr std::size_t reports = 200;

class VisibilityPass {
 public:
  VisibilityPass(const BlockedScene& scene, ExchangeMatrix& exchange_areas)
      : scene_(scene), tree_(scene.tree), exchange_(exchange_areas), in_sky_(tree_.clusters.size()) {
    // parents come before their children
    for (std::size_t k = tree_.clusters.size(); k-- > 0;) {
      const Cluster& cluster = tree_.clusters[k];
      in_sky_[k] = cluster.leaf() ? tree_.patches[cluster.begin].patch >= tree_.sky_begin
                                  : in_sky_[cluster.left] || in_sky_[cluster.right];
    }
  }

  VisibilityTally run(const Progress& progress) {
    std::vector<Block> blocks;
    VisibilityTally total;
    const auto n = static_cast<std::int64_t>(tree_.patches.size());
    limit_ = std::max<std::int64_t>(block_entries, n * n / 8192);
    split(tree_.root, tree_.root, all_candidates(scene_.set), blocks, total);
    std::vector<VisibilityTally> tallies(blocks.size());
    tbb::enumerable_thread_specific<BlockVisibility> workers(
        [&] { return BlockVisibility(scene_, exchange_); });
    std::mutex mutex;
    std::size_t done = 0;
    const std::size_t step = std::max<std::size_t>(1, blocks.size() / reports);
    tbb::task_group_context context;
    bool cancelled = false;
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, blocks.size(), 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t k = range.begin(); k < range.end(); ++k) {
            tallies[k] = workers.local()(blocks[k]);
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
    for (const VisibilityTally& tally : tallies) total += tally;
    return total;
  }

 private:
  std::int64_t entries(int a, int b) const {
    return static_cast<std::int64_t>(tree_.clusters[a].size()) * tree_.clusters[b].size();
  }

  // Descends from a pair of clusters, the same one twice included, to blocks of at most limit_ entries.
  void split(int a, int b, const std::vector<Candidate>& inherited, std::vector<Block>& blocks,
             VisibilityTally& tally) {
    const Cluster &ca = tree_.clusters[a], &cb = tree_.clusters[b];
    if (a == b) {
      if (ca.leaf() || ca.planar) return;
      split(ca.left, ca.left, inherited, blocks, tally);
      split(ca.right, ca.right, inherited, blocks, tally);
      split(ca.left, ca.right, inherited, blocks, tally);
      return;
    }
    if (!may_face(ca, cb)) return;
    ShaftCandidates found = candidates_in_shaft(scene_.ends[a], scene_.ends[b], scene_.set, inherited);
    if (!in_sky_[a] && !in_sky_[b]) {
      std::erase_if(found.list, [&](const Candidate& c) { return scene_.set.occluders[c.occluder].idle; });
    }
    if (found.hidden) {
      hide_block(tree_, a, b, exchange_, tally);
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

  const BlockedScene& scene_;
  const ClusterTree& tree_;
  ExchangeMatrix& exchange_;
  std::vector<char> in_sky_;  // of each cluster, whether it holds patches of the sky
  std::int64_t limit_ = block_entries;
};

}  // namespace

void subtract_hidden(const PatchMesh& mesh, const ClusterTree& tree, const FormFactorOptions& options,
                     ExchangeMatrix& exchange_areas, FormFactorReport& report, const Progress& progress) {
  const OccluderSet set = occluder_set(mesh, tree, options.keep_idle_occluders);
  for (const Occluder& occluder : set.occluders) report.occluders += occluder.face_count();
  if (set.occluders.empty()) return;
  const VisibilityTally tally =
      VisibilityPass(BlockedScene(mesh, tree, set, options, exchange_areas), exchange_areas).run(progress);
  report.hidden_pairs = tally.hidden;
  report.partial_pairs = tally.partial;
  report.exact_pairs = tally.exact;
  report.sampled_pairs = tally.sampled;
  report.rays = tally.rays;
  double total = 0;
  for (const WorkPatch& patch : tree.patches) {
    if (patch.patch < tree.sky_begin) total += patch.area;
  }
  // rows err by sqrt(sum_j e_ij^2) / A_i; their mean square is weighted by area
  report.estimated_error =
      std::sqrt(report.estimated_error * report.estimated_error + tally.squared_error / total);
}

}  // namespace luxel
