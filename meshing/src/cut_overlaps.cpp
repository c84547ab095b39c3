#include "cut_overlaps.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "box_tree.h"
#include "convex_clip.h"
#include "flat_polygons.h"
#include "place_corners.h"
#include "vertices_on_edges.h"

namespace luxel {

namespace {

// As a share of the smaller of two facets: bodies much smaller than the scene keep their shape.
constexpr double tolerance_share = 1e-3;

enum Side : char { no_side = 0, front_side = 1, back_side = 2 };

char flipped(char sides) {
  return static_cast<char>((sides & front_side ? back_side : no_side) |
                           (sides & back_side ? front_side : no_side));
}

struct Piece {
  ConvexPiece polygon;
  char sides;
};

/// What is left of one facet.
struct Rest {
  std::vector<Piece> pieces;
  double lost = 0;       // area of sides [m2]
  int first_above = -1;  // the first facet that took some
};

class Cutter {
 public:
  Cutter(const Facets& facets, const Regions& regions, const std::vector<OverlappingPair>& overlaps)
      : facets_(facets), regions_(regions), distance_(touching_distance(facets.vertices)) {
    std::vector<int> concerned;
    for (const OverlappingPair& pair : overlaps) {
      const char second = sides_of_region(pair.second);
      if ((sides_of_region(pair.first) & (pair.opposed ? flipped(second) : second)) == no_side) continue;
      pairs_.emplace_back(pair.first, pair.second);
      concerned.push_back(pair.first);
      concerned.push_back(pair.second);
    }
    std::sort(pairs_.begin(), pairs_.end());
    std::sort(concerned.begin(), concerned.end());
    concerned.erase(std::unique(concerned.begin(), concerned.end()), concerned.end());
    for (const int r : concerned) members_.insert(members_.end(), regions[r].begin(), regions[r].end());
    std::sort(members_.begin(), members_.end());
    std::vector<Box> boxes;
    for (const int facet : members_) boxes.push_back(box_of(facet));
    tree_.emplace(std::move(boxes));
  }

  /// The facets that may be cut, ascending.
  const std::vector<int>& members() const { return members_; }

  /// The vertices of those and of what may cut them, ascending.
  std::vector<int> vertices() const {
    std::vector<int> vertices;
    for (const int facet : members_) {
      vertices.insert(vertices.end(), facets_.loop(facet).begin(), facets_.loop(facet).end());
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
  }

  /// What facets before this one leave of it; no pieces and nothing lost: it stays as it is.
  Rest rest_of(int facet) const {
    Rest rest;
    const std::vector<int> above = candidates(facet);
    if (above.empty()) return rest;
    const Frame frame = frame_of(facet);
    std::vector<Piece> pieces;
    for (ConvexPiece& part : convex_parts(facet, frame)) pieces.push_back({std::move(part), sides_of(facet)});
    for (const int other : above) {
      const bool opposed = frame.n.dot(area_of(other)) < 0;
      const char taken = opposed ? flipped(sides_of(other)) : sides_of(other);
      const double tolerance = tolerance_of(facet, other);
      for (const std::vector<Vec2>& cutter : cutters(other, frame, opposed)) {
        std::vector<Piece> left;
        for (Piece& piece : pieces) {
          if ((piece.sides & taken) == no_side) {
            left.push_back(std::move(piece));
            continue;
          }
          Subtraction parts = subtract(piece.polygon, cutter, tolerance);
          for (ConvexPiece& part : parts.outside) left.push_back({std::move(part), piece.sides});
          if (parts.inside.empty()) continue;
          const char lost = piece.sides & taken;
          rest.lost += flat_area(parts.inside) * ((lost & front_side ? 1 : 0) + (lost & back_side ? 1 : 0));
          if (rest.first_above < 0) rest.first_above = other;
          const char kept = static_cast<char>(piece.sides & ~taken);
          if (kept != no_side) left.push_back({std::move(parts.inside), kept});
        }
        pieces = std::move(left);
      }
    }
    if (rest.first_above >= 0) rest.pieces = std::move(pieces);
    return rest;
  }

 private:
  std::vector<Vec3> points(int facet) const {
    std::vector<Vec3> points;
    for (const int v : facets_.loop(facet)) points.push_back(facets_.vertices[v]);
    return points;
  }

  Vec3 area_of(int facet) const { return area_vector(points(facet)); }

  Box box_of(int facet) const {
    Box box;
    for (const int v : facets_.loop(facet)) box.extend(facets_.vertices[v]);
    return box;
  }

  char sides_of(int facet) const {
    return static_cast<char>((facets_.front[facet] ? front_side : no_side) |
                             (facets_.back[facet] ? back_side : no_side));
  }

  char sides_of_region(int region) const {
    int sides = no_side;
    for (const int facet : regions_[region]) sides |= sides_of(facet);
    return static_cast<char>(sides);
  }

  Frame frame_of(int facet) const {
    Frame frame;
    frame.origin = facets_.vertices[facets_.loop(facet)[0]];
    frame.n = area_of(facet).normalized();
    const auto axes = plane_axes(frame.n);
    frame.u = axes[0];
    frame.v = axes[1];
    return frame;
  }

  double tolerance_of(int a, int b) const {
    const double size = std::min(longest_edge(points(a)), longest_edge(points(b)));
    return std::max(rounding(points(a)), std::min(distance_, tolerance_share * size));
  }

  bool overlap(int region, int other) const {
    return std::binary_search(pairs_.begin(), pairs_.end(),
                              std::pair(std::min(region, other), std::max(region, other)));
  }

  /// Facets before this one that may cover some of it, ascending.
  std::vector<int> candidates(int facet) const {
    std::vector<int> found;
    const int region = regions_.region_of_facet[facet];
    Box box = box_of(facet);
    box.min().array() -= 2 * distance_;
    box.max().array() += 2 * distance_;
    tree_->query(box, [&](int k) {
      const int other = members_[k];
      if (other < facet && overlap(region, regions_.region_of_facet[other])) found.push_back(other);
    });
    std::sort(found.begin(), found.end());
    return found;
  }

  /// Places in the loop of the facet's convex parts.
  std::vector<std::vector<int>> parts_of(int facet) const {
    const std::vector<Vec3> loop = points(facet);
    if (loop.size() == 3) return {{0, 1, 2}};
    if (loop.size() == 4 && is_convex(loop)) return {{0, 1, 2, 3}};
    std::vector<std::vector<int>> parts;
    for (const auto& [a, b, c] : triangulate_loop(loop)) {
      const std::array<Vec3, 3> triangle = {loop[a], loop[b], loop[c]};
      if (has_area(triangle)) parts.push_back({a, b, c});
    }
    return parts;
  }

  std::vector<ConvexPiece> convex_parts(int facet, const Frame& frame) const {
    std::vector<ConvexPiece> parts;
    for (const std::vector<int>& part : parts_of(facet)) {
      ConvexPiece& piece = parts.emplace_back();
      for (const int k : part) {
        const int v = facets_.loop(facet)[k];
        piece.push_back({frame.flat(facets_.vertices[v]), facets_.vertices[v], v});
      }
    }
    return parts;
  }

  std::vector<std::vector<Vec2>> cutters(int facet, const Frame& frame, bool opposed) const {
    std::vector<std::vector<Vec2>> result;
    for (const std::vector<int>& part : parts_of(facet)) {
      std::vector<Vec2>& cutter = result.emplace_back();
      for (const int k : part) cutter.push_back(frame.flat(facets_.vertices[facets_.loop(facet)[k]]));
      if (opposed) std::reverse(cutter.begin(), cutter.end());
    }
    return result;
  }

  const Facets& facets_;
  const Regions& regions_;
  double distance_;
  std::vector<std::pair<int, int>> pairs_;
  std::vector<int> members_;
  std::optional<BoxTree> tree_;
};

}  // namespace

std::optional<CutFacets> cut_overlaps(const Facets& facets, const Regions& regions,
                                      const std::vector<OverlappingPair>& overlaps) {
  if (overlaps.empty()) return std::nullopt;
  const Cutter cutter(facets, regions, overlaps);
  CutFacets result;
  std::map<int, Rest> rests;  // of the facets that lose something
  for (const int facet : cutter.members()) {
    Rest rest = cutter.rest_of(facet);
    if (rest.first_above < 0) continue;
    result.area += rest.lost;
    const int face = facets.faces[facet];
    if (rests.empty()) {
      result.first_face = face;
      result.first_above = facets.faces[rest.first_above];
    }
    if (rests.empty() || facets.faces[rests.rbegin()->first] != face) ++result.faces;
    rests.emplace_hint(rests.end(), facet, std::move(rest));
  }
  if (rests.empty()) return std::nullopt;

  std::vector<ClipCorner*> corners;  // that clipping made
  for (auto& [facet, rest] : rests) {
    for (Piece& piece : rest.pieces) {
      for (ClipCorner& corner : piece.polygon) {
        if (corner.vertex < 0) corners.push_back(&corner);
      }
    }
  }
  result.facets = facets;
  place_corners(corners, cutter.vertices(), touching_distance(facets.vertices), result.facets.vertices);

  Facets& cut = result.facets;
  cut.loops = {};
  cut.faces.clear();
  cut.front.clear();
  cut.back.clear();
  const auto append = [&](std::span<const int> loop, int facet, char front, char back) {
    cut.loops.append(loop);
    cut.faces.push_back(facets.faces[facet]);
    cut.front.push_back(front);
    cut.back.push_back(back);
  };
  std::vector<int> loop;
  std::vector<Vec3> points;
  for (int facet = 0; facet < facets.size(); ++facet) {
    const auto found = rests.find(facet);
    if (found == rests.end()) {
      append(facets.loop(facet), facet, facets.front[facet], facets.back[facet]);
      continue;
    }
    for (const Piece& piece : found->second.pieces) {
      loop.clear();
      points.clear();
      for (const ClipCorner& corner : piece.polygon) {
        if (std::ranges::find(loop, corner.vertex) != loop.end()) continue;  // welded
        loop.push_back(corner.vertex);
        points.push_back(cut.vertices[corner.vertex]);
      }
      if (!has_area(points)) continue;
      append(loop, facet, (piece.sides & front_side) != 0, (piece.sides & back_side) != 0);
    }
  }
  return result;
}

}  // namespace luxel
