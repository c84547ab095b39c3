#include "form_factors/hidden_pair.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "form_factors/event_cuts.h"
#include "luxel/form_factors.h"

namespace luxel {

namespace {

// Six times the volume of eye, edge (of length 1) and target is rounded by a few units in the last place of
// coordinates up to 1: below this an edge passes by.
constexpr double volume_rounding = 1e-14;

// Parts of a patch below this share of its area are what clipping leaves of a common edge.
constexpr double sliver_share = 1e-12;

// A patch that reaches through a face's plane by less than this share of its width touches the plane: the
// noise of files with six digits is of that size. What is taken for wholly visible then is that share of the
// patch.
constexpr double touching_share = 1e-7;

// Cells that the planes of faces and the events may cut one patch into.
constexpr std::size_t most_cells = 400;

// Below this relative tolerance the outer patch is cut by events before anything is evaluated; above, it is
// cheaper to look first.
constexpr double cut_first = 2e-3;

double side(const Span& span) {
  return span.high > -span.low ? span.high : span.low;
}

double touching_depth(const WorkPatch& patch) {
  return std::max(side_tolerance, touching_share * patch.area / patch.edge);
}

}  // namespace

HiddenPair::HiddenPair(const PatchMesh& mesh, const ClusterTree& tree, const OccluderSet& set)
    : mesh_(mesh), tree_(tree), set_(set) {}

HiddenPair::Ends HiddenPair::ends(int s, int t, const std::vector<Candidate>& candidates) const {
  const WorkPatch *first = &tree_.patches[s], *second = &tree_.patches[t];
  // the outer patch is the one on which shadows move less from edge to edge: far from the occluders, or small
  double along = 0;
  for (const Candidate& candidate : candidates) {
    const Vec3& at = set_.occluders[candidate.occluder].centre;
    const double a = (at - first->centroid).norm(), b = (at - second->centroid).norm();
    along += a / (a + b) / static_cast<double>(candidates.size());
  }
  if (first->edge * (1 - along) > second->edge * along) std::swap(first, second);
  Ends ends{first, second, {}, {}};
  ends.cell = clip(first->outline, second->plane, side_tolerance);
  ends.target = clip(second->outline, first->plane, side_tolerance);
  return ends;
}

// A patch's own polygon does not hide it; noise might say otherwise. Neither does the body that it is part
// of.
bool HiddenPair::own(const Occluder& occluder, const Ends& ends) const {
  const int outer = mesh_.polygons[ends.outer->patch], inner = mesh_.polygons[ends.inner->patch];
  for (int f = occluder.begin; f < occluder.end; ++f) {
    const int polygon = set_.faces[f].polygon;
    if (polygon == outer || polygon == inner) return true;
  }
  return false;
}

std::vector<Polygon> HiddenPair::cells_by_side(const Ends& ends,
                                               const std::vector<Candidate>& candidates) const {
  std::vector<Polygon> cells{ends.cell};
  const double length = ends.outer->edge, depth = touching_depth(*ends.outer);
  for (const Candidate& candidate : candidates) {
    const Occluder& occluder = set_.occluders[candidate.occluder];
    if (own(occluder, ends)) continue;
    for (int f = occluder.begin; f < occluder.end; ++f) {
      const Plane& plane = set_.faces[f].plane;
      const Span span = span_along(ends.cell, plane);
      if (span.low > -depth || span.high < depth || cells.size() >= most_cells) continue;
      const double slant = plane.normal.cross(ends.outer->plane.normal).norm();
      const double tolerance = std::max(side_tolerance, 1e-9 * length * slant);
      std::vector<Polygon> parts;
      for (const Polygon& cell : cells) {
        const Halves both = halves(cell, plane, tolerance);
        for (const Polygon* part : {&both.front, &both.behind}) {
          if (part->count >= 3) parts.push_back(*part);
        }
      }
      cells.swap(parts);
    }
  }
  return cells;
}

// The cut of the target by a face's plane bounds what lies behind the face.
bool HiddenPair::add_cut(const Polygon& cell, const Polygon& target, const Plane& behind) {
  Vec3 ends[2];
  int found = 0;
  // the corner farthest from the plane, on either side of it, tells on which side of the cut it lies
  Vec3 farthest = target[0];
  double height = 0;
  for (int k = 0; k < target.count; ++k) {
    const double here = behind.distance(target[k]), there = behind.distance(target.next(k));
    if (std::abs(here) > std::abs(height)) {
      height = here;
      farthest = target[k];
    }
    if ((here >= 0) == (there >= 0)) continue;
    if (found < 2) ends[found++] = target[k] + (here / (here - there)) * (target.next(k) - target[k]);
  }
  if (found < 2 || (ends[1] - ends[0]).squaredNorm() < 1e-28) return false;
  const Vec3 eye = centroid(cell);
  const double volume = (ends[1] - eye).cross(ends[0] - eye).dot(farthest - eye);
  if ((volume < 0) == (height < 0)) std::swap(ends[0], ends[1]);
  cuts_.push_back({ends[0], ends[1]});
  return true;
}

HiddenPair::Cast HiddenPair::cast(const Polygon& cell, const Ends& ends, const Occluder& occluder) {
  edges_.clear();
  cuts_.clear();
  const double depth = touching_depth(*ends.inner);
  if (!occluder.body()) {
    const OccluderFace& face = set_.faces[occluder.begin];
    const double height = side(span_along(cell, face.plane));
    if (std::abs(height) <= side_tolerance) return Cast::misses;
    const Plane seen = height > 0 ? face.plane : face.plane.flipped();
    const Span span = span_along(ends.target, seen);
    if (span.low >= -depth) return Cast::misses;
    if (span.high > depth) add_cut(cell, ends.target, seen);
    for (int k = 0; k < face.outline.count; ++k) {
      if (height > 0) {
        edges_.push_back({face.outline[k], face.outline.next(k)});
      } else {
        edges_.push_back({face.outline.next(k), face.outline[k]});
      }
    }
  } else {
    unsigned front = 0;
    for (int k = 0; k < occluder.face_count(); ++k) {
      const Plane& plane = set_.faces[occluder.begin + k].plane;
      const double height = side(span_along(cell, plane));
      if (height <= side_tolerance) continue;
      front |= 1u << k;
      const Span span = span_along(ends.target, plane);
      if (span.low >= -depth) return Cast::misses;
      if (span.high > depth) add_cut(cell, ends.target, plane);
    }
    if (front == 0) return Cast::misses;
    for (const BodyEdge& edge : occluder.edges) {
      const bool left = front >> edge.face & 1u, right = front >> edge.neighbour & 1u;
      if (left && !right) edges_.push_back({edge.p, edge.q});
      if (right && !left) edges_.push_back({edge.q, edge.p});
    }
  }

  // an edge matters where some line of sight passes it on the one side and some on the other
  const std::size_t first = shadows_.edges.size();
  for (const ShadowEdge& edge : edges_) {
    const Vec3 along = (edge.q - edge.p).normalized(), moment = edge.p.cross(along);
    double low = 0, high = 0;
    for (std::size_t k = 0; k < lines_.size(); ++k) {
      const double volume = -(moment.dot(sights_[k]) + along.dot(lines_[k]));
      low = std::min(low, volume);
      high = std::max(high, volume);
    }
    if (high <= volume_rounding) {
      shadows_.edges.resize(first);
      return Cast::misses;
    }
    if (low < -volume_rounding) shadows_.edges.push_back(edge);
  }
  shadows_.edges.insert(shadows_.edges.end(), cuts_.begin(), cuts_.end());
  if (shadows_.edges.size() == first) return Cast::everything;
  shadows_.begin.push_back(static_cast<int>(shadows_.edges.size()));
  shadows_.cut.push_back(!cuts_.empty());
  return Cast::shadow;
}

HiddenPair::Cast HiddenPair::cast_all(const Polygon& cell, const Ends& ends,
                                      const std::vector<Candidate>& candidates) {
  shadows_.clear();
  lines_.clear();
  sights_.clear();
  for (int k = 0; k < cell.count; ++k) {
    for (int l = 0; l < ends.target.count; ++l) {
      lines_.push_back(cell[k].cross(ends.target[l]));
      sights_.push_back(ends.target[l] - cell[k]);
    }
  }
  for (const Candidate& candidate : candidates) {
    const Occluder& occluder = set_.occluders[candidate.occluder];
    if (own(occluder, ends)) continue;
    if (cast(cell, ends, occluder) == Cast::everything) return Cast::everything;
  }
  if (shadows_.count() == 0) return Cast::misses;
  find_ties(shadows_);
  return Cast::shadow;
}

bool HiddenPair::covered(const Polygon& cell, const Ends& ends, const std::vector<Candidate>& candidates) {
  const Cast cast = cast_all(cell, ends, candidates);
  if (cast != Cast::shadow) return cast == Cast::everything;
  return HiddenQuadrature(ends.target, ends.outer->plane.normal, shadows_, workspace_).cover(cell);
}

HiddenPart HiddenPair::operator()(int s, int t, const std::vector<Candidate>& candidates, double unhidden,
                                  double tolerance) {
  const Ends pair = ends(s, t, candidates);
  HiddenPart part;
  if (pair.cell.count < 3 || pair.target.count < 3) return part;
  const Vec3& normal = pair.outer->plane.normal;
  const double whole = area(pair.cell, normal);
  if (!(whole > sliver_share * pair.outer->area)) return part;
  const std::vector<Polygon> cells = cells_by_side(pair, candidates);
  std::size_t dark = 0;
  for (const Polygon& cell : cells) {
    const double share = area(cell, normal) / whole;
    if (!(share > sliver_share)) {
      ++dark;
      continue;
    }
    const Cast cast = cast_all(cell, pair, candidates);
    if (cast == Cast::misses) continue;
    if (cast == Cast::everything) {
      ++dark;
      if (cells.size() > 1) {
        part.value +=
            exchange_area(std::span(cell.corners.data(), static_cast<std::size_t>(cell.count)),
                          std::span(pair.target.corners.data(), static_cast<std::size_t>(pair.target.count)));
      }
      continue;
    }
    HiddenQuadrature quadrature(pair.target, normal, shadows_, workspace_);
    const double allowed = tolerance * std::sqrt(share);
    HiddenIntegral integral;
    if (tolerance > cut_first * unhidden) {
      integral = quadrature.kinked(std::span(&cell, 1), area(cell, normal), allowed);
    } else {
      const std::vector<Polygon> smooth =
          cut_by_events(cell, normal, pair.target, shadows_, pair.outer->edge, most_cells);
      integral = shadows_.count() == 1
                     ? quadrature.smooth(smooth, unhidden * share, area(cell, normal), allowed)
                     : quadrature.cut(smooth, area(cell, normal), allowed);
    }
    part.value += integral.value;
    part.error += integral.error;
  }
  part.all = dark == cells.size();
  // several occluders may hide together what none hides alone: what is left then is the integral's error
  if (!part.all && unhidden - part.value <= 4 * tolerance + part.error) {
    part.all = std::all_of(cells.begin(), cells.end(), [&](const Polygon& cell) {
      return !(area(cell, normal) > sliver_share * whole) || covered(cell, pair, candidates);
    });
  }
  if (part.all) part.value = unhidden;
  part.value = std::clamp(part.value, 0.0, unhidden);
  return part;
}

}  // namespace luxel
