#include "transport/hierarchical/node_interpolation.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace luxel {

namespace {

constexpr std::size_t ends_a_task = 64;

template <class Ends, class Body>
void for_ends(const Ends& ends, const Body& body) {
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, ends.size(), ends_a_task),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t k = range.begin(); k < range.end(); ++k) body(ends[k]);
      },
      tbb::simple_partitioner());
}

}  // namespace

NodeInterpolation::NodeInterpolation(const PatchHierarchy& hierarchy, const ActiveTree& tree)
    : order_(hierarchy.order),
      coordinates_(hierarchy.order.size()),
      areas_(hierarchy.mesh->areas),
      node_areas_(tree.unknowns, 0.0) {
  for (const ActiveNode& node : tree.nodes) {
    if (node.unknown < 0) continue;
    const int position = node.cluster - hierarchy.cluster_count();
    if (node.single) {
      ends_.push_back({position, position + 1, node.unknown, true});
    } else {
      const PatchCluster& cluster = hierarchy.clusters[node.cluster];
      ends_.push_back({cluster.begin, cluster.end, node.unknown, false});
    }
  }
  std::sort(ends_.begin(), ends_.end(), [](const End& a, const End& b) { return a.begin < b.begin; });
  std::vector<int> cluster_of_unknown(tree.unknowns);
  for (const ActiveNode& node : tree.nodes) {
    if (node.unknown >= 0) cluster_of_unknown[node.unknown] = node.cluster;
  }
  for_ends(ends_, [&](const End& end) {
    if (end.single) {
      node_areas_[end.unknown] = areas_[order_[end.begin]];
      return;
    }
    const ClusterAxes& axes = hierarchy.clusters[cluster_of_unknown[end.unknown]].axes;
    for (int k = end.begin; k < end.end; ++k) {
      const Vec3 x = hierarchy.frame(hierarchy.mesh->centroids[order_[k]]) - axes.middle;
      coordinates_[k] = {static_cast<float>(axes.u.dot(x) / axes.spread_s),
                         static_cast<float>(axes.v.dot(x) / axes.spread_t)};
      const std::array<double, 4> f = functions(k);
      for (int a = 0; a < 4; ++a) node_areas_[end.unknown + a] += areas_[order_[k]] * f[a];
    }
  });
}

std::array<double, 4> NodeInterpolation::functions(int position) const {
  const double s = coordinates_[position][0], t = coordinates_[position][1];
  return {0.25 * (1 - s) * (1 - t), 0.25 * (1 + s) * (1 - t), 0.25 * (1 - s) * (1 + t),
          0.25 * (1 + s) * (1 + t)};
}

std::vector<int> NodeInterpolation::patch_of_unknowns() const {
  std::vector<int> patches(unknowns());
  for (const End& end : ends_) {
    for (int a = 0; a < (end.single ? 1 : 4); ++a) patches[end.unknown + a] = order_[end.begin];
  }
  return patches;
}

void NodeInterpolation::to_nodes(const double* x, double* y, int columns) const {
  for_ends(ends_, [&](const End& end) {
    double* const out = y + static_cast<std::size_t>(end.unknown) * columns;
    if (end.single) {
      std::copy_n(x + static_cast<std::size_t>(order_[end.begin]) * columns, columns, out);
      return;
    }
    std::fill_n(out, 4 * columns, 0.0);
    for (int k = end.begin; k < end.end; ++k) {
      const double* const value = x + static_cast<std::size_t>(order_[k]) * columns;
      const std::array<double, 4> f = functions(k);
      for (int a = 0; a < 4; ++a) {
        for (int c = 0; c < columns; ++c) out[a * columns + c] += areas_[order_[k]] * f[a] * value[c];
      }
    }
    for (int a = 0; a < 4; ++a) {
      for (int c = 0; c < columns; ++c) out[a * columns + c] /= node_areas_[end.unknown + a];
    }
  });
}

void NodeInterpolation::to_patches(const double* x, double* y, int columns) const {
  for_ends(ends_, [&](const End& end) {
    const double* const in = x + static_cast<std::size_t>(end.unknown) * columns;
    if (end.single) {
      std::copy_n(in, columns, y + static_cast<std::size_t>(order_[end.begin]) * columns);
      return;
    }
    for (int k = end.begin; k < end.end; ++k) {
      double* const value = y + static_cast<std::size_t>(order_[k]) * columns;
      const std::array<double, 4> f = functions(k);
      for (int c = 0; c < columns; ++c) {
        value[c] =
            f[0] * in[c] + f[1] * in[columns + c] + f[2] * in[2 * columns + c] + f[3] * in[3 * columns + c];
      }
    }
  });
}

std::size_t NodeInterpolation::bytes() const {
  return ends_.size() * sizeof(End) + order_.size() * (sizeof(int) + 2 * sizeof(float)) +
         (areas_.size() + node_areas_.size()) * sizeof(double);
}

}  // namespace luxel
