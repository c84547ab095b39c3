#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "form_factors/assembly.h"
#include "form_factors/block_kernels.h"
#include "form_factors/block_walk.h"
#include "form_factors/matrix_writer.h"
#include "form_factors/pair.h"
#include "form_factors/rule_choice.h"

namespace luxel {

namespace {

// Blocks of at most this many patches a side are no longer divided for the sake of a rule's distance.
constexpr int smallest_block = 8;

// Tasks in the fixed list: enough to keep many cores busy to the end.
constexpr int task_count = 1024;

// Distance between two centres in longest edges.
double distance(const WorkPatch& a, const WorkPatch& b) {
  return (a.centroid - b.centroid).norm() / std::max(a.edge, b.edge);
}

struct Tally {
  std::int64_t facing = 0;
  double area = 0;   // sum of the exchange areas [m2]
  double error = 0;  // sum of estimated errors of exchange areas [m2]
};

class Assembly {
 public:
  Assembly(const ClusterTree& tree, double accuracy, ExchangeMatrix& matrix)
      : tree_(tree),
        choice_(rule_choice(accuracy, static_cast<int>(tree.patches.size()))),
        writer_(tree, matrix),
        planes_(patch_planes(tree.patches)) {
    for (int level = 1; level <= point_levels; ++level) points_[level] = patch_points(tree.patches, level);
    spread_.reserve(tree.clusters.size());
    for (const Cluster& cluster : tree.clusters) {
      double spread = 0;
      for (int k = cluster.begin; k < cluster.end; ++k) {
        spread = std::max(spread, (tree.patches[k].centroid - cluster.centre).norm());
      }
      spread_.push_back(spread);
    }
  }

  void fill(ClusterPair pair, Tally& tally) const {
    const Cluster &a = tree_.clusters[pair.a], &b = tree_.clusters[pair.b];
    if (pair.a == pair.b) {
      if (a.planar || a.leaf()) return;
      fill({a.left, a.left}, tally);
      fill({a.right, a.right}, tally);
      fill({a.left, a.right}, tally);
      return;
    }
    if (!may_face(a, b)) return;
    const bool small = a.size() <= smallest_block && b.size() <= smallest_block;
    if (in_front(a, b)) {
      const double edge = std::max(a.edge, b.edge), apart = (a.centre - b.centre).norm();
      const double reach = spread_[pair.a] + spread_[pair.b];
      const double nearest = (apart - reach) / edge;
      const int level = choice_.level(nearest);
      if (level > 0 && (small || level == choice_.level((apart + reach) / edge))) {
        fill_block(a, b, level, RuleChoice::error(level, nearest), tally);
        return;
      }
      if (small) {
        fill_rows(a, b, tally);
        return;
      }
    } else if (small) {
      fill_straddling(a, b, tally);
      return;
    }
    if (a.size() >= b.size()) {
      fill({a.left, pair.b}, tally);
      fill({a.right, pair.b}, tally);
    } else {
      fill({pair.a, b.left}, tally);
      fill({pair.a, b.right}, tally);
    }
  }

 private:
  // Whether all of both clusters' patches lie wholly in front of each other.
  static bool in_front(const Cluster& a, const Cluster& b) {
    return heights_over(a, b).low >= -plane_tolerance && heights_over(b, a).low >= -plane_tolerance;
  }

  void fill_block(const Cluster& a, const Cluster& b, int level, double error, Tally& tally) const {
    Tile tile;
    for (int i0 = a.begin; i0 < a.end; i0 += Tile::rows) {
      const int i1 = std::min(i0 + Tile::rows, a.end);
      for (int j0 = b.begin; j0 < b.end; j0 += Tile::columns) {
        const int j1 = std::min(j0 + Tile::columns, b.end);
        fill_tile(points_[level], planes_, i0, i1, j0, j1, choice_.fine, tile);
        add(tally, (i1 - i0) * (j1 - j0), writer_.write(tile, i0, i1, j0, j1), error);
      }
    }
  }

  // A small block whose pairs need different rules.
  void fill_rows(const Cluster& a, const Cluster& b, Tally& tally) const {
    Tile tile;
    for (int i = a.begin; i < a.end; ++i) {
      double nearest = 1e300;
      for (int j = b.begin; j < b.end; ++j) {
        nearest = std::min(nearest, distance(tree_.patches[i], tree_.patches[j]));
      }
      const int level = choice_.level(nearest);
      if (level > 0) {
        fill_tile(points_[level], planes_, i, i + 1, b.begin, b.end, choice_.fine, tile);
        add(tally, b.size(), writer_.write(tile, i, i + 1, b.begin, b.end),
            RuleChoice::error(level, nearest));
      } else {
        // the back of a sheet lies in the plane of its front: not behind, and not facing either
        for (int j = b.begin; j < b.end; ++j) fill_if_facing(i, j, tally);
      }
    }
  }

  // A small block that may hold pairs which see only part of each other, or nothing.
  void fill_straddling(const Cluster& a, const Cluster& b, Tally& tally) const {
    for (int i = a.begin; i < a.end; ++i) {
      for (int j = b.begin; j < b.end; ++j) fill_if_facing(i, j, tally);
    }
  }

  void fill_if_facing(int i, int j, Tally& tally) const {
    const WorkPatch &p = tree_.patches[i], &q = tree_.patches[j];
    const Span over_p = span_along(q.outline, p.plane);
    if (over_p.high <= plane_tolerance) return;
    const Span over_q = span_along(p.outline, q.plane);
    if (over_q.high <= plane_tolerance) return;
    fill_pair(i, j, over_p.low >= -plane_tolerance && over_q.low >= -plane_tolerance, tally);
  }

  int pair_level(const WorkPatch& p, const WorkPatch& q, double apart) const {
    const int level = choice_.level(apart), bold = choice_.level_if_apart(apart);
    if (level > 0 || bold == 0) return level;
    const double wide = RuleChoice::wide_gap * std::max(p.edge, q.edge);
    return gap(p.outline, p.plane, q.outline, q.plane) >= wide ? bold : 0;
  }

  void fill_pair(int i, int j, bool whole, Tally& tally) const {
    const WorkPatch &p = tree_.patches[i], &q = tree_.patches[j];
    const double apart = distance(p, q);
    const int level = pair_level(p, q, apart);
    if (whole && level > 0) {
      Tile tile;
      fill_tile(points_[level], planes_, i, i + 1, j, j + 1, choice_.fine, tile);
      add(tally, 1, writer_.write(tile, i, i + 1, j, j + 1), RuleChoice::error(level, apart));
      return;
    }
    const Polygon a = whole ? p.outline : clip(p.outline, q.plane, plane_tolerance);
    const Polygon b = whole ? q.outline : clip(q.outline, p.plane, plane_tolerance);
    if (a.count == 0 || b.count == 0) return;
    const double tolerance = choice_.pair_tolerance * std::min(p.area, q.area);
    const double value = level > 0 ? point_exchange(a, p.plane.normal, b, q.plane.normal, level)
                                   : contour_exchange(a, b, tolerance);
    writer_.write(i, j, value);
    add(tally, 1, std::max(value, 0.0) / (tree_.scale * tree_.scale), choice_.pair_tolerance);
  }

  static void add(Tally& tally, int pairs, double area, double error) {
    tally.facing += pairs;
    tally.area += area;
    tally.error += area * error;
  }

  const ClusterTree& tree_;
  RuleChoice choice_;
  MatrixWriter writer_;
  PatchPlanes planes_;
  std::array<PatchPoints, point_levels + 1> points_;
  std::vector<double> spread_;
};

}  // namespace

void fill_unoccluded(const ClusterTree& tree, double accuracy, ExchangeMatrix& exchange_areas,
                     FormFactorReport& report, const Progress& progress) {
  const auto n = static_cast<std::int64_t>(tree.patches.size());
  report.pairs = n * (n - 1) / 2;
  const std::vector<ClusterPair> tasks = facing_tasks(tree, task_count);
  const Assembly assembly(tree, accuracy, exchange_areas);
  std::vector<Tally> tallies(tasks.size());
  auto weight = [&](int k) {
    return static_cast<double>(tree.clusters[tasks[k].a].size()) * tree.clusters[tasks[k].b].size();
  };
  run_tasks(
      static_cast<int>(tasks.size()), [&](int k) { assembly.fill(tasks[k], tallies[k]); }, weight,
      "form factors", progress);
  double error = 0, total = 0;
  for (const Tally& tally : tallies) {
    report.facing_pairs += tally.facing;
    error += 2 * tally.error;
  }
  for (const WorkPatch& patch : tree.patches) {
    if (patch.patch < tree.sky_begin) total += metres_squared(tree, patch.area);
  }
  if (total > 0) report.estimated_error = error / total;
}

}  // namespace luxel
