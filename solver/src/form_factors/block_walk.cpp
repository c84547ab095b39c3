#include "form_factors/block_walk.h"

#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <mutex>

#include "luxel/input_error.h"

namespace luxel {

namespace {

double pairs_in(const ClusterTree& tree, ClusterPair pair) {
  const double a = tree.clusters[pair.a].size(), b = tree.clusters[pair.b].size();
  return pair.a == pair.b ? 0.5 * a * (a - 1) : a * b;
}

}  // namespace

std::vector<ClusterPair> facing_tasks(const ClusterTree& tree, int wanted) {
  if (tree.clusters.empty()) return {};
  const double all = pairs_in(tree, {tree.root, tree.root});
  const double largest = std::max(all / wanted, 1.0);
  std::vector<ClusterPair> tasks, open{{tree.root, tree.root}};
  while (!open.empty()) {
    const ClusterPair pair = open.back();
    open.pop_back();
    const Cluster &a = tree.clusters[pair.a], &b = tree.clusters[pair.b];
    if (pair.a == pair.b) {
      if (a.planar || a.leaf()) continue;
    } else if (!may_face(a, b)) {
      continue;
    }
    if (pairs_in(tree, pair) <= largest) {
      tasks.push_back(pair);
    } else if (pair.a == pair.b) {
      open.push_back({a.left, a.left});
      open.push_back({a.right, a.right});
      open.push_back({a.left, a.right});
    } else if (a.size() >= b.size()) {
      open.push_back({a.left, pair.b});
      open.push_back({a.right, pair.b});
    } else {
      open.push_back({pair.a, b.left});
      open.push_back({pair.a, b.right});
    }
  }
  // Large tasks first, so that the threads end together.
  std::stable_sort(tasks.begin(), tasks.end(), [&](const ClusterPair& p, const ClusterPair& q) {
    return pairs_in(tree, p) > pairs_in(tree, q);
  });
  return tasks;
}

void run_tasks(int count, const std::function<void(int)>& task, const std::function<double(int)>& weight,
               std::string_view stage, const Progress& progress) {
  double total = 0, done = 0;
  for (int k = 0; k < count; ++k) total += weight(k);
  std::mutex mutex;
  bool cancelled = false;
  // At most this many calls to the listener.
  constexpr double reports = 200;
  double reported = 0;
  tbb::task_group_context context;
  tbb::parallel_for(
      tbb::blocked_range<int>(0, count, 1),
      [&](const tbb::blocked_range<int>& range) {
        for (int k = range.begin(); k < range.end(); ++k) {
          if (context.is_group_execution_cancelled()) return;
          task(k);
          if (!progress) continue;
          const std::scoped_lock lock(mutex);
          done += weight(k);
          if (cancelled || (done < reported + total / reports && done < total)) continue;
          reported = done;
          if (!progress(stage, done, total)) {
            cancelled = true;
            context.cancel_group_execution();
          }
        }
      },
      tbb::simple_partitioner(), context);
  if (cancelled) throw Cancelled();
}

}  // namespace luxel
