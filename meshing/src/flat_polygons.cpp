#include "flat_polygons.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "corner_positions.h"
#include "polygon.h"

namespace luxel {

namespace {

// Sine of the largest turn that a straight border may have at a vertex; what it deviates by is bounded by the
// region's own tolerance too.
constexpr double straight_turn = 1e-3;

// Facets that a thread takes at a time, at least.
constexpr int facets_per_task = 4096;

/// Distance of p from the line through a and b [m].
double distance_to_line(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double length = d.norm();
  return length > 0 ? d.cross(p - a).norm() / length : (p - a).norm();
}

/// Finds which vertices stay and walks the borders from one to the next.
class BorderWalker {
 public:
  BorderWalker(const Facets& facets, const Regions& regions, const EdgeTable& edges,
               std::vector<char>& irregular)
      : facets_(facets),
        regions_(regions),
        irregular_(irregular),
        keep_(facets.vertices.size(), 0),
        next_(facets.vertices.size(), -1),
        previous_(facets.vertices.size(), -1),
        stamp_(facets.vertices.size(), 0) {
    borders_.reserve(facets.loops.entries.size());
    collect_borders(edges);
    for (int r = 0; r < regions.size(); ++r) keep_turns(r);
    for (bool changed = true; changed;) {
      changed = false;
      for (int r = 0; r < regions.size(); ++r) changed = keep_bends(r) || changed;
    }
  }

  void append_segments(int r, std::vector<std::array<int, 2>>& segments) {
    link(r);
    for (const auto& [a, b] : border(r)) {
      if (keep_[a]) segments.push_back({a, walk(b)});
    }
  }

 private:
  using Edge = std::array<int, 2>;

  std::span<const Edge> border(int r) const {
    return std::span(borders_).subspan(offsets_[r], offsets_[r + 1] - offsets_[r]);
  }

  /// The directed edges of each region that no other member of it runs against.
  void collect_borders(const EdgeTable& edges) {
    const std::vector<char> uses = count_uses(edges);
    for (int r = 0; r < regions_.size(); ++r) {
      for (const int facet : regions_[r]) {
        for (int h = facets_.loops.offsets[facet]; h < facets_.loops.offsets[facet + 1]; ++h) {
          if (uses[h] > 1) irregular_[r] = true;
          if (uses[h] > 0) borders_.push_back({edges.from(h), edges.to(h)});
        }
      }
      offsets_.push_back(static_cast<int>(borders_.size()));
    }
  }

  /// For each half-edge how often its region runs along it, less how often against it; 2 stands for more.
  std::vector<char> count_uses(const EdgeTable& edges) const {
    std::vector<char> uses(facets_.loops.entries.size());
    tbb::parallel_for(tbb::blocked_range<int>(0, facets_.size(), facets_per_task), [&](const auto& range) {
      for (int facet = range.begin(); facet < range.end(); ++facet) {
        const int r = regions_.region_of_facet[facet];
        for (int h = facets_.loops.offsets[facet]; h < facets_.loops.offsets[facet + 1]; ++h) {
          int net = 0;
          for (const int g : edges.uses(h)) {
            if (regions_.region_of_facet[edges.loop(g)] == r) net += edges.from(g) == edges.from(h) ? 1 : -1;
          }
          uses[h] = static_cast<char>(std::clamp(net, 0, 2));
        }
      }
    });
    return uses;
  }

  /// Chains the border of region r: next_ and previous_ hold on its vertices; -2 where it passes twice.
  void link(int r) {
    ++serial_;
    for (const auto& [a, b] : border(r)) {
      for (const int v : {a, b}) {
        if (stamp_[v] == serial_) continue;
        stamp_[v] = serial_;
        next_[v] = previous_[v] = -1;
      }
      next_[a] = next_[a] == -1 ? b : -2;
      previous_[b] = previous_[b] == -1 ? a : -2;
    }
  }

  void keep_turns(int r) {
    link(r);
    for (const auto& edge : border(r)) {
      const int v = edge[0];
      if (keep_[v]) continue;
      if (irregular_[r] || next_[v] < 0 || previous_[v] < 0) {
        keep_[v] = keep_[edge[1]] = true;
        continue;
      }
      const Vec3 in = facets_.vertices[v] - facets_.vertices[previous_[v]];
      const Vec3 out = facets_.vertices[next_[v]] - facets_.vertices[v];
      const double scale = in.norm() * out.norm();
      const bool straight = in.dot(out) > 0 && in.cross(out).norm() <= straight_turn * scale &&
                            distance_to_line(facets_.vertices[v], facets_.vertices[previous_[v]],
                                             facets_.vertices[next_[v]]) <= regions_.tolerances[r];
      if (!straight) keep_[v] = true;
    }
  }

  int walk(int v) const {
    while (!keep_[v]) v = next_[v];
    return v;
  }

  bool keep_bends(int r) {
    link(r);
    bool changed = false;
    int seen = 0;
    for (const auto& [a, b] : border(r)) {
      if (!keep_[a]) continue;
      const int end = walk(b);
      double deviation = 0;
      ++seen;
      for (int v = b; v != end; v = next_[v], ++seen) {
        deviation = std::max(
            deviation, distance_to_line(facets_.vertices[v], facets_.vertices[a], facets_.vertices[end]));
      }
      if (deviation <= regions_.tolerances[r]) continue;
      for (int v = b; v != end; v = next_[v]) keep_[v] = true;
      changed = true;
    }
    // A loop without any corner, or one that two corners close to nothing, is not reached or vanishes.
    if (!changed && seen < static_cast<int>(border(r).size())) {
      for (const auto& edge : border(r)) keep_[edge[0]] = true;
      changed = true;
    }
    return changed;
  }

  const Facets& facets_;
  const Regions& regions_;
  std::vector<char>& irregular_;
  std::vector<Edge> borders_;
  std::vector<int> offsets_{0};
  std::vector<char> keep_;
  std::vector<int> next_, previous_;
  std::vector<int> stamp_;  // the call of link() that a vertex was last seen in
  int serial_ = 0;
};

Frame fit_plane(const Facets& facets, const std::vector<Vec3>& areas, std::span<const int> members) {
  Vec3 area = Vec3::Zero();
  Vec3 moment = Vec3::Zero();
  double total = 0;
  const Vec3 start = facets.vertices[facets.loop(members[0])[0]];
  CornerPositions positions(facets.vertices);
  for (const int facet : members) {
    const std::span<const Vec3> points = positions(facets.loop(facet));
    const double weight = areas[facet].norm();
    area += areas[facet];
    moment += weight * (area_centroid(points, areas[facet]) - start);
    total += weight;
  }
  Frame frame;
  frame.n = area.normalized();
  frame.origin = start + moment / total;
  const auto axes = plane_axes(frame.n);
  frame.u = axes[0];
  frame.v = axes[1];
  return frame;
}

}  // namespace

std::vector<Vec3> facet_areas(const Facets& facets) {
  std::vector<Vec3> areas(facets.size());
  tbb::parallel_for(tbb::blocked_range<int>(0, facets.size(), facets_per_task), [&](const auto& range) {
    CornerPositions positions(facets.vertices);
    for (int i = range.begin(); i < range.end(); ++i) areas[i] = area_vector(positions(facets.loop(i)));
  });
  return areas;
}

FlatPolygons make_flat_polygons(const Facets& facets, const std::vector<Vec3>& areas, const EdgeTable& edges,
                                const Regions& regions, std::vector<char> irregular) {
  FlatPolygons polygons;
  polygons.irregular = std::move(irregular);
  polygons.irregular.resize(regions.size(), false);
  BorderWalker walker(facets, regions, edges, polygons.irregular);
  polygons.frames.resize(regions.size());
  tbb::parallel_for(tbb::blocked_range<int>(0, regions.size()), [&](const auto& range) {
    for (int r = range.begin(); r < range.end(); ++r) {
      polygons.frames[r] = fit_plane(facets, areas, regions[r]);
    }
  });
  for (int r = 0; r < regions.size(); ++r) {
    walker.append_segments(r, polygons.segments);
    polygons.segment_offsets.push_back(static_cast<int>(polygons.segments.size()));
  }
  return polygons;
}

}  // namespace luxel
