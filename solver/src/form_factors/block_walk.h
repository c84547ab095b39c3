#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "form_factors/cluster_tree.h"
#include "luxel/progress.h"

namespace luxel {

/// Two different clusters, or one with itself, as indices of ClusterTree::clusters.
struct ClusterPair {
  int a = 0, b = 0;
};

/// A fixed list of cluster pairs that face each other and together hold every facing pair of patches once.
/// Depends on the tree alone: tasks for any number of threads.
/// @param wanted  about how many
std::vector<ClusterPair> facing_tasks(const ClusterTree& tree, int wanted);

/// Runs task(k) for k = 0 .. count - 1 on TBB and reports `stage` as they end, weighted by weight(k).
/// @throws Cancelled if the listener says so
void run_tasks(int count, const std::function<void(int)>& task, const std::function<double(int)>& weight,
               std::string_view stage, const Progress& progress);

}  // namespace luxel
