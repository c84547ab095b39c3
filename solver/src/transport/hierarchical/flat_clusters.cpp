#include "transport/hierarchical/flat_clusters.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace luxel {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// A side is halved together with the other while it is longer than this share of it.
constexpr double square_enough = 0.6;

// Nodes whose weight is below this share of the cluster would be ill conditioned: an equal share is 0.25.
constexpr double least_weight = 0.02;

// Subtrees of more patches than this are built as tasks of their own.
constexpr std::ptrdiff_t patches_a_task = 4096;

using Patches = std::span<FlatPatch>;

// Halves at the middle of the centroids' range; a grid's middle row goes to the right as a whole. Empty on
// one side where all lie on one line.
std::ptrdiff_t halve(Patches patches, double FlatPatch::*coordinate) {
  double low = infinity, high = -infinity;
  for (const FlatPatch& patch : patches) {
    low = std::min(low, patch.*coordinate);
    high = std::max(high, patch.*coordinate);
  }
  const double middle = 0.5 * (low + high) - 1e-9 * (high - low);
  return std::stable_partition(patches.begin(), patches.end(),
                               [&](const FlatPatch& patch) { return patch.*coordinate < middle; }) -
         patches.begin();
}

// The parts of a cluster: two or four, none empty.
std::vector<Patches> parts_of(Patches patches, const std::array<double, 4>& box) {
  const double width = box[1] - box[0], height = box[3] - box[2];
  std::vector<Patches> parts{patches};
  const auto halve_all = [&](double FlatPatch::*coordinate) {
    std::vector<Patches> halves;
    for (Patches part : parts) {
      const std::ptrdiff_t left = halve(part, coordinate);
      if (left > 0) halves.push_back(part.first(left));
      if (left < std::ssize(part)) halves.push_back(part.subspan(left));
    }
    parts = std::move(halves);
  };
  if (width >= square_enough * height) halve_all(&FlatPatch::s);
  if (height >= square_enough * width || parts.size() == 1) halve_all(&FlatPatch::t);
  if (parts.size() == 1) halve_all(&FlatPatch::s);
  if (parts.size() == 1) {  // all in one place
    const std::size_t half = patches.size() / 2;
    parts = {patches.first(half), patches.subspan(half)};
  }
  return parts;
}

// Adds the tree over these patches, the first of which is number `first`; gives the number of its root.
int append_tree(Patches patches, int first, const FlatGroup& group, std::vector<PatchCluster>& tree) {
  const int root = static_cast<int>(tree.size());
  tree.push_back(flat_cluster(patches, group));
  tree[root].begin = first;
  tree[root].end = first + static_cast<int>(patches.size());
  const std::vector<Patches> parts = parts_of(patches, tree[root].box);
  const auto first_of = [&](Patches part) { return first + static_cast<int>(part.data() - patches.data()); };
  const bool divide = std::ssize(patches) > patches_a_task;
  std::vector<std::vector<PatchCluster>> subtrees(divide ? parts.size() : 0);
  tbb::parallel_for(std::size_t{0}, subtrees.size(), [&](std::size_t k) {
    if (parts[k].size() > 1) append_tree(parts[k], first_of(parts[k]), group, subtrees[k]);
  });
  for (std::size_t k = 0; k < parts.size(); ++k) {
    int child = -2 - first_of(parts[k]);
    if (parts[k].size() > 1 && divide) {
      child = static_cast<int>(tree.size());
      append(tree, subtrees[k]);
    } else if (parts[k].size() > 1) {
      child = append_tree(parts[k], first_of(parts[k]), group, tree);
    }
    if (child >= 0) tree[child].parent = root;
    tree[root].children[tree[root].child_count++] = child;
  }
  return root;
}

}  // namespace

void append(std::vector<PatchCluster>& clusters, const std::vector<PatchCluster>& more) {
  const int shift = static_cast<int>(clusters.size());
  for (PatchCluster cluster : more) {
    if (cluster.parent >= 0) cluster.parent += shift;
    for (int c = 0; c < cluster.child_count; ++c) {
      if (cluster.children[c] >= 0) cluster.children[c] += shift;
    }
    clusters.push_back(cluster);
  }
}

FlatPatch flat_patch(const PatchMesh& mesh, int patch, const WorkingFrame& frame, const FlatGroup& group) {
  FlatPatch result;
  result.patch = patch;
  result.s0 = result.t0 = infinity;
  result.s1 = result.t1 = -infinity;
  const int count = mesh.corner_count(patch);
  std::array<double, 4> s, t;
  for (int k = 0; k < count; ++k) {
    const Vec3 x = frame(mesh.vertices[mesh.corners[patch][k]]);
    s[k] = group.u.dot(x);
    t[k] = group.v.dot(x);
    result.s0 = std::min(result.s0, s[k]), result.s1 = std::max(result.s1, s[k]);
    result.t0 = std::min(result.t0, t[k]), result.t1 = std::max(result.t1, t[k]);
  }
  const Vec3 centroid = frame(mesh.centroids[patch]);
  result.s = group.u.dot(centroid);
  result.t = group.v.dot(centroid);
  result.area = mesh.areas[patch] * frame.scale * frame.scale;
  // a triangle's second moment about any point is a twelfth of its area times the sum over its corners and
  // over nine times its centre (all from that point)
  double total = 0;
  for (int k = 1; k + 1 < count; ++k) {
    const std::array<double, 3> ds{s[0] - result.s, s[k] - result.s, s[k + 1] - result.s};
    const std::array<double, 3> dt{t[0] - result.t, t[k] - result.t, t[k + 1] - result.t};
    const double area = 0.5 * ((ds[1] - ds[0]) * (dt[2] - dt[0]) - (ds[2] - ds[0]) * (dt[1] - dt[0]));
    const double sum_s = ds[0] + ds[1] + ds[2], sum_t = dt[0] + dt[1] + dt[2];
    double ss = sum_s * sum_s, st = sum_s * sum_t, tt = sum_t * sum_t;
    for (int c = 0; c < 3; ++c) {
      ss += ds[c] * ds[c];
      st += ds[c] * dt[c];
      tt += dt[c] * dt[c];
    }
    result.ss += area / 12 * ss;
    result.st += area / 12 * st;
    result.tt += area / 12 * tt;
    total += area;
  }
  if (total > 0) {
    result.ss /= total;
    result.st /= total;
    result.tt /= total;
  }
  return result;
}

PatchCluster flat_cluster(std::span<const FlatPatch> patches, const FlatGroup& group) {
  PatchCluster cluster;
  double s = 0, t = 0;
  double s0 = infinity, s1 = -infinity, t0 = infinity, t1 = -infinity;
  for (const FlatPatch& patch : patches) {
    cluster.area += patch.area;
    s += patch.area * patch.s;
    t += patch.area * patch.t;
    s0 = std::min(s0, patch.s0), s1 = std::max(s1, patch.s1);
    t0 = std::min(t0, patch.t0), t1 = std::max(t1, patch.t1);
  }
  s /= cluster.area;
  t /= cluster.area;
  double ss = 0, st = 0, tt = 0;
  for (const FlatPatch& patch : patches) {
    const double ds = patch.s - s, dt = patch.t - t;
    ss += patch.area * (ds * ds + patch.ss);
    st += patch.area * ds * dt;
    tt += patch.area * (dt * dt + patch.tt);
  }
  if (patches.size() == 1) st = patches[0].area * patches[0].st;
  ClusterAxes& axes = cluster.axes;
  axes.u = group.u;
  axes.v = group.v;
  axes.middle = s * group.u + t * group.v + group.offset * group.normal;
  axes.spread_s = std::sqrt(std::max(ss / cluster.area, 1e-300));
  axes.spread_t = std::sqrt(std::max(tt / cluster.area, 1e-300));
  const double mixed = std::clamp(st / (cluster.area * axes.spread_s * axes.spread_t), -1.0, 1.0);
  for (int a = 0; a < 4; ++a) cluster.weights[a] = 0.25 * (1 + ((a & 1) == a >> 1 ? mixed : -mixed));
  cluster.usable = 0.25 * (1 - std::abs(mixed)) >= least_weight;
  cluster.box = {s0 - s, s1 - s, t0 - t, t1 - t};
  cluster.centre = axes.middle + 0.5 * (s0 + s1 - 2 * s) * group.u + 0.5 * (t0 + t1 - 2 * t) * group.v;
  cluster.radius = 0.5 * std::hypot(s1 - s0, t1 - t0);
  return cluster;
}

std::vector<PatchCluster> flat_tree(Patches patches, const FlatGroup& group) {
  std::vector<PatchCluster> tree;
  append_tree(patches, 0, group, tree);
  return tree;
}

}  // namespace luxel
