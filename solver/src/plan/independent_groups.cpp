#include "plan/independent_groups.h"

#include <numeric>

#include "form_factors/cluster_tree.h"
#include "luxel/plan.h"

namespace luxel {

namespace {

/// Joins open enclosures whose patches may face each other, cluster by cluster.
class FacingSets {
 public:
  /// @param enclosure  of each patch of the mesh, in [0, count)
  FacingSets(const PatchMesh& mesh, std::vector<int> enclosure, int count)
      : tree_(cluster_tree(mesh)),
        enclosure_(std::move(enclosure)),
        parent_(count),
        uniform_(tree_.clusters.size()) {
    std::iota(parent_.begin(), parent_.end(), 0);
    for (int k = static_cast<int>(tree_.clusters.size()) - 1; k >= 0; --k) {
      const Cluster& cluster = tree_.clusters[k];
      uniform_[k] = cluster.leaf() || uniform(cluster);
    }
    join(tree_.root, tree_.root);
  }

  int root(int enclosure) {
    while (parent_[enclosure] != enclosure) enclosure = parent_[enclosure] = parent_[parent_[enclosure]];
    return enclosure;
  }

 private:
  int set_of(const Cluster& cluster) { return root(enclosure_[tree_.patches[cluster.begin].patch]); }

  // children come after their parents
  bool uniform(const Cluster& cluster) {
    return uniform_[cluster.left] && uniform_[cluster.right] &&
           set_of(tree_.clusters[cluster.left]) == set_of(tree_.clusters[cluster.right]);
  }

  bool of_one_set(int k) {
    if (!uniform_[k]) uniform_[k] = uniform(tree_.clusters[k]);  // sets only grow
    return uniform_[k];
  }

  void join(int a, int b) {
    const Cluster &ca = tree_.clusters[a], &cb = tree_.clusters[b];
    if (of_one_set(a) && of_one_set(b) && set_of(ca) == set_of(cb)) return;
    if (a == b) {
      if (ca.leaf() || ca.planar) return;
      join(ca.left, ca.right);
      join(ca.left, ca.left);
      join(ca.right, ca.right);
    } else if (!may_face(ca, cb)) {
      return;
    } else if (ca.leaf() && cb.leaf()) {
      parent_[set_of(ca)] = set_of(cb);
    } else if (cb.leaf() || (!ca.leaf() && ca.size() >= cb.size())) {
      join(ca.left, b);
      join(ca.right, b);
    } else {
      join(a, cb.left);
      join(a, cb.right);
    }
  }

  ClusterTree tree_;
  std::vector<int> enclosure_;
  std::vector<int> parent_;
  std::vector<char> uniform_;  ///< all patches of the cluster are known to be of one set
};

/// For each enclosure one that stands for its group.
std::vector<int> joined(const PatchMesh& mesh, const Enclosures& enclosures) {
  std::vector<int> group(enclosures.count);
  std::iota(group.begin(), group.end(), 0);
  std::vector<int> open_patches, enclosure_of;
  int open = 0;
  for (int e = 0; e < enclosures.count; ++e) open += !enclosures.enclosure_closed[e];
  if (open < 2) return group;
  for (int i = 0; i < mesh.size(); ++i) {
    if (enclosures.enclosure_closed[enclosures.enclosure[i]]) continue;
    open_patches.push_back(i);
    enclosure_of.push_back(enclosures.enclosure[i]);
  }
  FacingSets sets(sub_mesh(mesh, open_patches, true), std::move(enclosure_of), enclosures.count);
  for (int e = 0; e < enclosures.count; ++e) group[e] = sets.root(e);
  return group;
}

}  // namespace

PatchGroups independent_groups(const PatchMesh& mesh, const Enclosures& enclosures) {
  const std::vector<int> representative = joined(mesh, enclosures);
  PatchGroups groups;
  std::vector<int> place(enclosures.count, -1);
  for (int i = 0; i < mesh.size(); ++i) {
    const int e = enclosures.enclosure[i];
    int& group = place[representative[e]];
    if (group < 0) {
      group = static_cast<int>(groups.patches.size());
      groups.patches.emplace_back();
      groups.closed.push_back(enclosures.enclosure_closed[e]);
    }
    groups.patches[group].push_back(i);
  }
  return groups;
}

}  // namespace luxel
