#include "form_factors/block_sights.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "form_factors/ray_visibility.h"
#include "form_factors/sight_lines.h"

namespace luxel {

namespace {

// However few rays the error asks for, there is one for so many pairs: shadows narrower than that are left to
// chance.
constexpr double pairs_a_ray = 1;

// Beyond so many rays a pair, those that are left undecided are cheaper one by one.
constexpr double most_rays_a_pair = 64;

// These rays must not be the ones by which parts are measured: they would count twice.
constexpr std::uint64_t stream = 0x626c6f636b73;

// Powers of 1 / g, g the real root of x^3 = x + 1: rows and columns of a block in the order of lowest
// discrepancy known in two dimensions (Roberts 2018).
constexpr double row_step = 0.7548776662466927, column_step = 0.5698402909980532;

// So many rays that agree may have missed a share of the block that falls as 1 / N. It is a corner of the
// block: of a few rows, and the larger a part of those. In the root mean square over rows it is about
// agreement N^-agreement_order; measured on a torus in a sphere.
constexpr double agreement = 0.3, agreement_order = 0.75;

// Lines between corners keep off them by this share of the way to the middle of the patch.
constexpr double off_corner = 0.02;

// Patches have at most so many corners.
constexpr int most_corners = 4;

// Rays that must agree for an error of this share of a row.
double rays_for(double error) {
  return std::pow(agreement / error, 1 / agreement_order);
}

// The corners of a cluster that reach furthest in eight directions along it.
std::vector<PatchCorner> outermost_corners(const ClusterTree& tree, const Cluster& cluster) {
  const Vec3 u = cluster.plane.normal.unitOrthogonal(), v = cluster.plane.normal.cross(u);
  std::vector<PatchCorner> found;
  for (const auto& [along_u, along_v] : std::array<std::array<double, 2>, 8>{
           {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}}) {
    const Vec3 direction = along_u * u + along_v * v;
    PatchCorner furthest{cluster.begin, 0};
    double reach = -std::numeric_limits<double>::infinity();
    for (int k = cluster.begin; k < cluster.end; ++k) {
      const Polygon& outline = tree.patches[k].outline;
      for (int c = 0; c < std::min(outline.count, most_corners); ++c) {
        const double here = direction.dot(outline[c] - cluster.centre);
        if (here > reach) reach = here, furthest = {k, c};
      }
    }
    if (std::find(found.begin(), found.end(), furthest) == found.end()) found.push_back(furthest);
  }
  return found;
}

class BlockSort {
 public:
  BlockSort(const SightSorter& sorter, const ClusterTree& tree, const OccluderScene& scene,
            std::uint64_t seed, int a, int b, std::span<const double> unhidden, double factor)
      : sorter_(sorter),
        tree_(tree),
        seed_(seed),
        first_row_(tree.clusters[a].begin),
        first_column_(tree.clusters[b].begin),
        columns_(tree.clusters[b].size()),
        unhidden_(unhidden),
        factor_(factor),
        cast_(unhidden.size()),
        arrived_(unhidden.size()),
        next_(unhidden.size()),
        corners_(unhidden.size()),
        sights_(unhidden.size(), Sight::unknown),
        packet_(scene, Count{*this}) {}

  BlockSights sort(int a, int b) {
    std::vector<Node> open{{a, b}}, next;
    while (!open.empty()) {
      for (Node& node : open) ask(node);
      packet_.trace();
      next.clear();
      for (const Node& node : open) judge(node, next);
      open.swap(next);
    }
    return {std::move(sights_), rays_};
  }

 private:
  struct Node {
    int a, b;
    double wanted = 0;
  };

  struct Count {
    BlockSort& sort;
    void operator()(std::size_t pair, double, bool arrives) const {
      ++sort.cast_[pair];
      sort.arrived_[pair] += arrives;
      ++sort.rays_;
    }
  };

  // What is known of a node.
  struct Sum {
    int pairs = 0, cast = 0, arrived = 0;
    double unhidden = 0;
    bool agrees() const { return arrived == 0 || arrived == cast; }
  };

  template <class OnPair>
  void for_each_pair(const Node& node, OnPair on_pair) const {
    const Cluster &a = tree_.clusters[node.a], &b = tree_.clusters[node.b];
    for (int s = a.begin; s < a.end; ++s) {
      for (int t = b.begin; t < b.end; ++t) {
        const std::size_t pair = index(s, t);
        if (unhidden_[pair] > 0) on_pair(s, t, pair);
      }
    }
  }
  std::size_t index(int s, int t) const {
    return static_cast<std::size_t>(s - first_row_) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(t - first_column_);
  }

  Sum sum(const Node& node) const {
    Sum sum;
    for_each_pair(node, [&](int, int, std::size_t pair) {
      ++sum.pairs;
      sum.cast += cast_[pair];
      sum.arrived += arrived_[pair];
      sum.unhidden += unhidden_[pair];
    });
    return sum;
  }

  // Casts what is missing for the node to be decided, unless its rays disagree already.
  void ask(Node& node) {
    const Sum known = sum(node);
    if (known.pairs == 0 || !known.agrees()) return;
    const double smaller = std::min(sorter_.area(node.a), sorter_.area(node.b));
    node.wanted = std::max(std::ceil(rays_for(factor_ * std::sqrt(smaller / known.unhidden))),
                           std::ceil(known.pairs / pairs_a_ray));
    if (node.wanted > most_rays_a_pair * known.pairs) return;
    int missing = static_cast<int>(node.wanted) - known.cast;
    for (const PatchCorner& from : sorter_.outermost(node.a)) {
      for (const PatchCorner& to : sorter_.outermost(node.b)) missing -= cast(from, to);
    }
    if (missing >= known.pairs) {
      const int each = missing / known.pairs;
      for_each_pair(node, [&](int s, int t, std::size_t pair) { cast(s, t, pair, each); });
      missing -= each * known.pairs;
    }
    scatter(node, missing, known.cast);
  }

  // Rays to pairs that lie evenly over the node.
  void scatter(const Node& node, int count, int from) {
    const Cluster &a = tree_.clusters[node.a], &b = tree_.clusters[node.b];
    const int tries = 4 * count;
    for (int k = from; count > 0 && k < from + tries; ++k) {
      const double row = row_step * (k + 1), column = column_step * (k + 1);
      const int s = a.begin + static_cast<int>((row - std::floor(row)) * a.size());
      const int t = b.begin + static_cast<int>((column - std::floor(column)) * b.size());
      const std::size_t pair = index(s, t);
      if (!(unhidden_[pair] > 0)) continue;
      cast(s, t, pair, 1);
      --count;
    }
  }

  // The line between two corners, if it has not been asked for before. A boundary of what is hidden that runs
  // into a block cuts off such corners first.
  bool cast(const PatchCorner& from, const PatchCorner& to) {
    const std::size_t pair = index(from.patch, to.patch);
    const auto line = static_cast<std::uint16_t>(1u << (from.corner * most_corners + to.corner));
    if (!(unhidden_[pair] > 0) || corners_[pair] & line) return false;
    corners_[pair] |= line;
    const SightLine sight =
        sight_line(tree_.patches[from.patch], near_corner(from), tree_.patches[to.patch], near_corner(to));
    if (!(sight.weight > 0)) return false;
    packet_.add(pair, sight);
    return true;
  }
  Vec3 near_corner(const PatchCorner& corner) const {
    const WorkPatch& patch = tree_.patches[corner.patch];
    return patch.outline[corner.corner] + off_corner * (patch.centroid - patch.outline[corner.corner]);
  }

  void cast(int s, int t, std::size_t pair, int count) {
    const SightLines lines(tree_.patches[s], tree_.patches[t], seed_);
    for (int k = 0; k < count; ++k) {
      const SightLine line = lines[next_[pair]++];
      if (line.weight > 0) packet_.add(pair, line);
    }
  }

  void judge(const Node& node, std::vector<Node>& next) {
    const Sum known = sum(node);
    if (known.pairs == 0) return;
    // ends that straddle each other's plane lose some rays
    const bool decided = known.agrees() && node.wanted > 0 && known.cast >= std::max(1.0, node.wanted / 2);
    const Cluster &a = tree_.clusters[node.a], &b = tree_.clusters[node.b];
    if (decided || (a.leaf() && b.leaf())) {
      const Sight sight = !decided ? Sight::part : known.arrived > 0 ? Sight::whole : Sight::none;
      for_each_pair(node, [&](int, int, std::size_t pair) { sights_[pair] = sight; });
    } else if (b.leaf() || (!a.leaf() && a.size() >= b.size())) {
      next.push_back({a.left, node.b});
      next.push_back({a.right, node.b});
    } else {
      next.push_back({node.a, b.left});
      next.push_back({node.a, b.right});
    }
  }

  const SightSorter& sorter_;
  const ClusterTree& tree_;
  std::uint64_t seed_;
  int first_row_, first_column_, columns_;
  std::span<const double> unhidden_;
  double factor_;
  std::vector<int> cast_, arrived_, next_;  // of each pair: rays, those that arrive, lines used
  std::vector<std::uint16_t> corners_;      // lines between corners that were asked for, one bit each
  std::vector<Sight> sights_;
  std::int64_t rays_ = 0;
  SightPacket<Count> packet_;
};

}  // namespace

SightSorter::SightSorter(const ClusterTree& tree, const OccluderScene& scene, std::uint64_t seed)
    : tree_(tree), scene_(scene), seed_(seed ^ stream) {
  outermost_.reserve(tree.clusters.size());
  areas_.reserve(tree.clusters.size());
  for (const Cluster& cluster : tree.clusters) {
    double area = 0;
    for (int k = cluster.begin; k < cluster.end; ++k) area += tree.patches[k].area;
    areas_.push_back(area);
    outermost_.push_back(cluster.size() <= largest_side ? outermost_corners(tree, cluster)
                                                        : std::vector<PatchCorner>());
  }
}

BlockSights SightSorter::sort(int a, int b, std::span<const double> unhidden, double factor) const {
  return BlockSort(*this, tree_, scene_, seed_, a, b, unhidden, factor).sort(a, b);
}

}  // namespace luxel
