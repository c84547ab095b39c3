#include "overlapping_polygons.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

#include "box_pairs.h"
#include "box_tree.h"
#include "convex_clip.h"
#include "plane_groups.h"
#include "vertices_on_edges.h"
#include "weld.h"

namespace luxel {

namespace {

// Pairs of triangles up to which they are tried one by one.
constexpr std::size_t most_trials = 64;

// How far apart two sheets of one plane may be, in distances within which a vertex lies on an edge: each may
// be off its own plane by one.
constexpr double apart = 2;

// The same as a share of the smaller polygon: bodies much smaller than the scene keep their shape.
constexpr double share_of_size = 1e-3;

// Where more members than this share of the polygons are in groups, the boxes of all are made in their order:
// one look into memory for each member then, not five.
constexpr double share_worth_all = 0.25;

using Pair = std::pair<int, int>;

/// Whether what boxes that touch have in common is wider than `least` in two directions.
bool share_area(const Box& a, const Box& b, double least) {
  const Vec3 common = a.max().cwiseMin(b.max()) - a.min().cwiseMax(b.min());
  return (common.array() > least).count() >= 2;
}

/// Tells which polygons have a part of one plane in common.
class OverlapTest {
 public:
  OverlapTest(const std::vector<Vec3>& vertices, const MergedPolygons& merged)
      : vertices_(vertices), merged_(merged), distance_(touching_distance(vertices)) {}

  double distance() const { return distance_; }

  /// The box of a polygon, with half of what two may be apart on all sides.
  Box box(int polygon) const {
    Box box;
    for (const auto& segment : merged_.polygons.border(polygon)) box.extend(vertices_[segment[0]]);
    box.min().array() -= apart / 2 * distance_;
    box.max().array() += apart / 2 * distance_;
    return box;
  }

  bool overlap(int p, int q) {
    const auto& triangles = merged_.triangles;
    const bool swapped = triangles[p].size() < triangles[q].size();
    const int many = swapped ? q : p, few = swapped ? p : q;
    if (!in_one_plane(p, q)) return false;
    if (triangles[many].size() * triangles[few].size() <= most_trials) {
      for (const auto& s : triangles[few]) {
        for (const auto& t : triangles[many]) {
          if (overlap(s, t, merged_.polygons.frames[few])) return true;
        }
      }
      return false;
    }
    const BoxTree& tree = tree_of(many);
    bool found = false;
    for (const auto& s : triangles[few]) {
      tree.query(box_of(s), [&](int t) {
        found = found || overlap(s, triangles[many][t], merged_.polygons.frames[few]);
      });
      if (found) return true;
    }
    return false;
  }

  /// Whether facets' triangles of one irregular polygon lie over each other.
  bool overlaps_itself(int p) {
    const auto& triangles = merged_.triangles[p];
    const BoxTree& tree = tree_of(p);
    bool found = false;
    for (std::size_t s = 0; s < triangles.size() && !found; ++s) {
      tree.query(box_of(triangles[s]), [&](int t) {
        if (found || t <= static_cast<int>(s)) return;
        found = overlap(triangles[s], triangles[t], merged_.polygons.frames[p]);
      });
    }
    return found;
  }

 private:
  using Triangle = std::array<int, 3>;

  Box box_of(const Triangle& t) const {
    Box box(vertices_[t[0]]);
    box.extend(vertices_[t[1]]);
    box.extend(vertices_[t[2]]);
    return box;
  }

  const BoxTree& tree_of(int p) {
    if (!tree_ || polygon_of_tree_ != p) {
      std::vector<Box> boxes;
      boxes.reserve(merged_.triangles[p].size());
      for (const auto& t : merged_.triangles[p]) {
        Box box = box_of(t);
        box.min().array() -= apart * distance_;
        box.max().array() += apart * distance_;
        boxes.push_back(box);
      }
      tree_ = std::make_unique<BoxTree>(std::move(boxes));
      polygon_of_tree_ = p;
    }
    return *tree_;
  }

  /// Whether one of the two, whose directions are much alike, lies in the plane of the other.
  bool in_one_plane(int p, int q) const {
    const auto lies_in = [&](int small, int large) {
      double size = 0;
      const auto border = merged_.polygons.border(small);
      for (const auto& [a, b] : border) size = std::max(size, (vertices_[b] - vertices_[a]).norm());
      const double limit = std::max(rounding_of(border), std::min(apart * distance_, share_of_size * size));
      return std::ranges::all_of(border, [&](const auto& segment) {
        return std::abs(merged_.polygons.frames[large].height(vertices_[segment[0]])) <= limit;
      });
    };
    return lies_in(p, q) || lies_in(q, p);
  }

  double rounding_of(std::span<const std::array<int, 2>> border) const {
    const std::array<Vec3, 1> corner = {vertices_[border[0][0]]};
    return rounding(corner);
  }

  bool overlap(const Triangle& s, const Triangle& t, const Frame& frame) const {
    if (!share_area(box_of(s), box_of(t), distance_)) return false;
    piece_.clear();
    for (const int v : s) piece_.push_back({frame.flat(vertices_[v]), vertices_[v], v});
    std::array<Vec2, 3> cutter;
    for (int k = 0; k < 3; ++k) cutter[k] = frame.flat(vertices_[t[k]]);
    const Vec2 a = cutter[1] - cutter[0], b = cutter[2] - cutter[0];
    if (a.x() * b.y() < a.y() * b.x()) std::swap(cutter[1], cutter[2]);
    return !subtract(piece_, cutter, distance_).inside.empty();
  }

  const std::vector<Vec3>& vertices_;
  const MergedPolygons& merged_;
  double distance_;
  std::unique_ptr<BoxTree> tree_;
  int polygon_of_tree_ = -1;
  mutable ConvexPiece piece_;
};

}  // namespace

std::vector<OverlappingPair> find_overlapping(const std::vector<Vec3>& vertices,
                                              const MergedPolygons& merged) {
  const std::vector<Frame>& frames = merged.polygons.frames;
  Box all;
  for (const Vec3& p : vertices) all.extend(p);
  const PlaneGroups groups = group_by_plane(frames, all.center(), all.diagonal().norm());

  const bool irregular =
      std::ranges::find(merged.polygons.irregular, true) != merged.polygons.irregular.end();
  if (groups.size() == 0 && !irregular) return {};
  OverlapTest test(vertices, merged);
  std::vector<Pair> pairs;
  std::vector<Box> boxes, all_boxes;
  if (groups.members.size() > share_worth_all * frames.size()) {
    all_boxes.reserve(frames.size());
    for (int p = 0; p < merged.polygons.size(); ++p) all_boxes.push_back(test.box(p));
  }
  for (int g = 0; g < groups.size(); ++g) {
    const auto group =
        std::span(groups.members).subspan(groups.offsets[g], groups.offsets[g + 1] - groups.offsets[g]);
    boxes.clear();
    for (const int p : group) boxes.push_back(all_boxes.empty() ? test.box(p) : all_boxes[p]);
    for (const auto& [a, b] : touching_pairs(boxes)) {
      const bool overlap = share_area(boxes[a], boxes[b], (1 + apart) * test.distance());
      if (overlap && group[a] != group[b]) pairs.emplace_back(group[a], group[b]);
    }
  }
  for (int p = 0; p < merged.polygons.size(); ++p) {
    if (merged.polygons.irregular[p] && merged.triangles[p].size() > 1) pairs.emplace_back(p, p);
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  // by the polygon of more triangles, whose tree then serves all its pairs
  const auto takes_a_tree = [&](const Pair& pair) {
    return merged.triangles[pair.first].size() * merged.triangles[pair.second].size() > most_trials;
  };
  const auto larger = [&](const Pair& pair) {
    return merged.triangles[pair.first].size() < merged.triangles[pair.second].size() ? pair.second
                                                                                      : pair.first;
  };
  const auto trees = std::stable_partition(pairs.begin(), pairs.end(),
                                           [&](const Pair& pair) { return !takes_a_tree(pair); });
  std::stable_sort(trees, pairs.end(), [&](const Pair& x, const Pair& y) { return larger(x) < larger(y); });

  std::vector<OverlappingPair> found;
  for (const auto& [p, q] : pairs) {
    if (p == q ? test.overlaps_itself(p) : test.overlap(p, q)) {
      found.push_back({p, q, frames[p].n.dot(frames[q].n) < 0});
    }
  }
  std::sort(found.begin(), found.end(), [](const OverlappingPair& x, const OverlappingPair& y) {
    return x.first != y.first ? x.first < y.first : x.second < y.second;
  });
  return found;
}

}  // namespace luxel
