#include "transport/hierarchical/patch_hierarchy.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <tuple>

#include "transport/hierarchical/curved_clusters.h"
#include "transport/hierarchical/flat_clusters.h"
#include "transport/hierarchical/patch_groups.h"

namespace luxel {

namespace {

// How much a turn of the normal by 1 rad weighs against a distance of one scene diagonal when groups are
// gathered: bodies first, then their sides.
constexpr double normal_weight = 0.3;

using Feature = Eigen::Array<double, 6, 1>;
using Ints = std::vector<int>::iterator;

class Builder {
 public:
  Builder(const PatchMesh& mesh, const Enclosures& enclosures) {
    result_.mesh = &mesh;
    result_.frame = working_frame(mesh);
    gather_flat_groups(result_, enclosures);
  }

  PatchHierarchy build() {
    if (result_.groups.empty()) return std::move(result_);
    find_features();
    std::vector<int> groups(result_.groups.size());
    std::iota(groups.begin(), groups.end(), 0);
    sort_groups(groups.begin(), groups.end());
    lay_out(groups);
    build_groups();
    std::size_t count = groups.size();
    for (const std::vector<PatchCluster>& tree : trees_) count += tree.size();
    result_.clusters.reserve(count);
    int position = 0;
    result_.root = emit(0, static_cast<int>(groups.size()), -1, position);
    fill_curved();
    number_single_patches();
    return std::move(result_);
  }

 private:
  const PatchMesh& mesh() const { return *result_.mesh; }

  void find_features() {
    const std::size_t count = result_.groups.size();
    features_.assign(count, Feature::Zero());
    sizes_.assign(count, 0);
    for (int g : result_.group) ++sizes_[g];
    std::vector<int> starts(count + 1, 0);
    std::partial_sum(sizes_.begin(), sizes_.end(), starts.begin() + 1);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t g) {
      double total = 0;
      for (int k = starts[g]; k < starts[g + 1]; ++k) {
        const int p = result_.order[k];
        const double area = mesh().areas[p];
        features_[g].head<3>() += area * result_.frame(mesh().centroids[p]).array();
        features_[g].tail<3>() += area * normal_weight * mesh().normals[p].array();
        total += area;
      }
      features_[g] /= total;
    });
  }

  // Sorts groups into the order of a tree that halves them along their widest feature; divisions_ keeps
  // where.
  void sort_groups(Ints begin, Ints end) {
    if (end - begin < 2) return;
    const Ints base = begin;
    Feature low = features_[*begin], high = low;
    for (Ints g = begin; g != end; ++g) {
      low = low.min(features_[*g]);
      high = high.max(features_[*g]);
    }
    int axis = 0;
    (high - low).maxCoeff(&axis);
    const double middle = 0.5 * (low[axis] + high[axis]) - 1e-9 * (high[axis] - low[axis]);
    Ints division = std::stable_partition(begin, end, [&](int g) { return features_[g][axis] < middle; });
    if (division == begin || division == end) division = begin + (end - begin) / 2;
    divisions_.push_back(static_cast<int>(division - base));
    sort_groups(begin, division);
    sort_groups(division, end);
  }

  // Patches in the order of the sorted groups, which are renumbered.
  void lay_out(const std::vector<int>& groups) {
    std::vector<int> starts(groups.size() + 1, 0);
    for (std::size_t g = 0; g < groups.size(); ++g) starts[g + 1] = starts[g] + sizes_[g];
    std::vector<int> order;
    std::vector<FlatGroup> sorted;
    order.reserve(result_.order.size());
    begins_.assign(1, 0);
    for (std::size_t k = 0; k < groups.size(); ++k) {
      const int g = groups[k];
      for (int q = starts[g]; q < starts[g + 1]; ++q) {
        result_.group[order.size()] = static_cast<int>(k);
        order.push_back(result_.order[q]);
      }
      sorted.push_back(result_.groups[g]);
      begins_.push_back(static_cast<int>(order.size()));
    }
    result_.order = std::move(order);
    result_.groups = std::move(sorted);
  }

  void build_groups() {
    trees_.resize(result_.groups.size());
    tbb::parallel_for(std::size_t{0}, trees_.size(), [&](std::size_t g) {
      const int begin = begins_[g], end = begins_[g + 1];
      if (end - begin < 2) return;
      std::vector<FlatPatch> patches;
      patches.reserve(end - begin);
      for (int k = begin; k < end; ++k) {
        patches.push_back(flat_patch(mesh(), result_.order[k], result_.frame, result_.groups[g]));
      }
      trees_[g] = flat_tree(patches, result_.groups[g]);
      for (int k = begin; k < end; ++k) result_.order[k] = patches[k - begin].patch;
    });
  }

  // Adds the clusters of sorted groups [begin, end) in the order of sort_groups(); gives their root.
  int emit(int begin, int end, int parent, int& division) {
    if (end - begin == 1) return emit_group(begin, parent);
    const int id = static_cast<int>(result_.clusters.size());
    result_.clusters.emplace_back();
    PatchCluster cluster;
    cluster.parent = parent;
    cluster.curved = static_cast<int>(spans_.size());
    spans_.push_back({id, begin, end});
    const int middle = begin + divisions_[division++];
    cluster.children[0] = emit(begin, middle, id, division);
    cluster.children[1] = emit(middle, end, id, division);
    cluster.child_count = 2;
    result_.clusters[id] = cluster;
    return id;
  }

  // What emit() left out: each is computed by itself, but that a cluster with parts that are not usable is
  // not either.
  void fill_curved() {
    result_.curved.resize(spans_.size());
    tbb::parallel_for(std::size_t{0}, spans_.size(), [&](std::size_t k) {
      const auto [id, begin, end] = spans_[k];
      PatchCluster& at = result_.clusters[id];
      PatchCluster filled =
          curved_cluster(result_, begins_[begin], begins_[end], begin, end, result_.curved[k]);
      filled.parent = at.parent;
      filled.curved = at.curved;
      filled.children = at.children;
      filled.child_count = at.child_count;
      at = filled;
    });
    for (std::size_t k = spans_.size(); k-- > 0;) {
      PatchCluster& cluster = result_.clusters[spans_[k].id];
      for (int child : {cluster.children[0], cluster.children[1]}) {
        if (child >= 0 && result_.clusters[child].flat_group < 0) {
          cluster.usable &= result_.clusters[child].usable;
        }
      }
    }
  }

  int emit_group(int group, int parent) {
    const int first = begins_[group], shift = static_cast<int>(result_.clusters.size());
    if (trees_[group].empty()) return -2 - first;
    for (PatchCluster& cluster : trees_[group]) {
      cluster.begin += first;
      cluster.end += first;
      cluster.flat_group = group;
      for (int c = 0; c < cluster.child_count; ++c) {
        if (cluster.children[c] < 0) cluster.children[c] -= first;
      }
    }
    append(result_.clusters, trees_[group]);
    trees_[group] = {};
    result_.clusters[shift].parent = parent;
    return shift;
  }

  void number_single_patches() {
    const auto number = [&](int child) { return child < 0 ? result_.cluster_count() - 2 - child : child; };
    for (PatchCluster& cluster : result_.clusters) {
      for (int c = 0; c < cluster.child_count; ++c) cluster.children[c] = number(cluster.children[c]);
    }
    result_.root = number(result_.root);
  }

  struct GroupSpan {
    int id;          // of the cluster
    int begin, end;  // sorted groups
  };

  PatchHierarchy result_;
  std::vector<Feature> features_;
  std::vector<int> sizes_;        // patches of each group
  std::vector<int> divisions_;    // of sort_groups(), in preorder: groups on the left
  std::vector<int> begins_;       // of sorted groups in the order of patches
  std::vector<GroupSpan> spans_;  // of clusters of several groups, parents first
  std::vector<std::vector<PatchCluster>> trees_;
};

}  // namespace

std::array<double, 4> ClusterAxes::functions(const Vec3& x) const {
  const double s = u.dot(x - middle) / spread_s, t = v.dot(x - middle) / spread_t;
  return {0.25 * (1 - s) * (1 - t), 0.25 * (1 + s) * (1 - t), 0.25 * (1 - s) * (1 + t),
          0.25 * (1 + s) * (1 + t)};
}

PatchHierarchy patch_hierarchy(const PatchMesh& mesh, const Enclosures& enclosures) {
  if (static_cast<int>(enclosures.enclosure.size()) != mesh.size()) {
    throw std::invalid_argument("patch_hierarchy: enclosures are of another mesh");
  }
  return Builder(mesh, enclosures).build();
}

}  // namespace luxel
