#include "transport/hierarchical/active_tree.h"

namespace luxel {

namespace {

// Of all clusters and single patches: whether a block ends there.
std::vector<char> ends_of_blocks(const PatchHierarchy& hierarchy, const std::vector<BlockList>& lists) {
  std::vector<char> ends(hierarchy.clusters.size() + hierarchy.order.size(), 0);
  const auto mark = [&](const auto& blocks) {
    for (const auto& block : blocks) ends[block.r] = ends[block.s] = 1;
  };
  for (const BlockList& list : lists) {
    mark(list.scalars);
    mark(list.linears);
    mark(list.bilinears);
  }
  return ends;
}

// Of each cluster: whether it must be divided into its children, because a block ends inside, or because it
// cannot hold unknowns.
std::vector<char> divided_clusters(const PatchHierarchy& hierarchy, const std::vector<char>& ends) {
  const int count = hierarchy.cluster_count();
  std::vector<char> divided(count, 0);
  std::vector<int> finish(count), enclosure(count);
  for (int c = count - 1; c >= 0; --c) {
    const PatchCluster& cluster = hierarchy.clusters[c];
    divided[c] = !cluster.usable;
    for (int k = 0; k < cluster.child_count; ++k) {
      const int child = cluster.children[k];
      divided[c] |= ends[child] || (!hierarchy.single(child) && divided[child]);
    }
    const FlatGroup& first = hierarchy.groups[hierarchy.group[cluster.begin]];
    finish[c] = first.finish;
    enclosure[c] = first.enclosure;
    if (cluster.flat_group >= 0) continue;
    for (int k = 0; k < cluster.child_count; ++k) {
      const int child = cluster.children[k];
      const FlatGroup& group =
          hierarchy.groups[hierarchy.group[hierarchy.single(child) ? child - count
                                                                   : hierarchy.clusters[child].begin]];
      const bool mixed = !hierarchy.single(child) && finish[child] < 0;
      if (mixed || group.finish != first.finish || group.enclosure != first.enclosure) finish[c] = -1;
    }
    divided[c] |= finish[c] < 0;
  }
  return divided;
}

// Zeros where no block ends at the parent or above.
std::array<float, 16> transfer_to(const PatchHierarchy& hierarchy, int cluster, const PatchCluster& parent) {
  std::array<float, 16> transfer{};
  if (parent.flat_group < 0 && !parent.usable) return transfer;
  const auto set = [&](int z, const Vec3& x) {
    const std::array<double, 4> f = parent.axes.functions(x);
    for (int a = 0; a < 4; ++a) transfer[4 * z + a] = static_cast<float>(f[a]);
  };
  if (hierarchy.single(cluster)) {
    set(0, hierarchy.frame(hierarchy.mesh->centroids[hierarchy.patch(cluster)]));
    return transfer;
  }
  const ClusterAxes& axes = hierarchy.clusters[cluster].axes;
  for (int z = 0; z < 4; ++z) {
    set(z,
        axes.middle + (z & 1 ? 1 : -1) * axes.spread_s * axes.u + (z & 2 ? 1 : -1) * axes.spread_t * axes.v);
  }
  return transfer;
}

}  // namespace

ActiveTree active_tree(const PatchHierarchy& hierarchy, const std::vector<BlockList>& blocks) {
  ActiveTree tree;
  if (hierarchy.order.empty()) return tree;
  const std::vector<char> ends = ends_of_blocks(hierarchy, blocks);
  const std::vector<char> divided = divided_clusters(hierarchy, ends);
  tree.number.assign(ends.size(), -1);
  const auto add = [&](int cluster, int parent) {
    tree.number[cluster] = static_cast<int>(tree.nodes.size());
    ActiveNode node;
    node.cluster = cluster;
    node.parent = parent;
    node.single = hierarchy.single(cluster);
    tree.nodes.push_back(node);
    tree.transfer.push_back(
        parent < 0 ? std::array<float, 16>{}
                   : transfer_to(hierarchy, cluster, hierarchy.clusters[tree.nodes[parent].cluster]));
  };
  add(hierarchy.root, -1);
  tree.levels = {0, 1};
  while (tree.levels.back() > tree.levels[tree.levels.size() - 2]) {
    const int begin = tree.levels[tree.levels.size() - 2], end = tree.levels.back();
    for (int n = begin; n < end; ++n) {
      const int cluster = tree.nodes[n].cluster;
      if (tree.nodes[n].single || !divided[cluster]) {
        tree.nodes[n].unknown = tree.unknowns;
        tree.unknowns += tree.nodes[n].single ? 1 : 4;
        continue;
      }
      const PatchCluster& inner = hierarchy.clusters[cluster];
      tree.nodes[n].first_child = static_cast<int>(tree.nodes.size());
      tree.nodes[n].child_count = inner.child_count;
      for (int k = 0; k < inner.child_count; ++k) add(inner.children[k], n);
    }
    tree.levels.push_back(static_cast<int>(tree.nodes.size()));
  }
  tree.levels.pop_back();
  return tree;
}

}  // namespace luxel
