#include "form_factors/hidden_pair.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "form_factors/event_cuts.h"
#include "luxel/form_factors.h"

namespace luxel {

namespace {

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

// Kinks that both rules miss alike are found by halving more than the rules' difference asks for.
constexpr double round_share = 0.5;
constexpr int round_halvings = 4;

}  // namespace

double touching_depth(const WorkPatch& patch) {
  return std::max(side_tolerance, touching_share * patch.area / patch.edge);
}

HiddenPair::HiddenPair(const PatchMesh& mesh, const ClusterTree& tree, const OccluderSet& set)
    : mesh_(mesh),
      tree_(tree),
      set_(set),
      round_body_(static_cast<std::size_t>(mesh.occluders.polygon_count), -1) {
  for (std::size_t k = 0; k < set.occluders.size(); ++k) {
    const Occluder& occluder = set.occluders[k];
    if (!occluder.round()) continue;
    for (int f = occluder.begin; f < occluder.end; ++f)
      round_body_[set.faces[f].polygon] = static_cast<int>(k);
  }
}

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
  // round bodies are on one side of the inner patch's plane, if they can be
  for (const Candidate& candidate : candidates) {
    const Occluder& occluder = set_.occluders[candidate.occluder];
    if (occluder.round() && side_of_plane(occluder, second->plane) == Side::both &&
        side_of_plane(occluder, first->plane) != Side::both) {
      std::swap(first, second);
      break;
    }
  }
  Ends ends{first, second, {}, {}};
  ends.cell = clip(first->outline, second->plane, side_tolerance);
  ends.target = clip(second->outline, first->plane, side_tolerance);
  return ends;
}

// A patch's own polygon does not hide it; noise might say otherwise. Neither does the body that it is part
// of.
bool HiddenPair::own(const Occluder& occluder, const Ends& ends) const {
  const int outer = mesh_.polygons[ends.outer->patch], inner = mesh_.polygons[ends.inner->patch];
  if (occluder.round()) {
    const auto k = static_cast<int>(&occluder - set_.occluders.data());
    return round_body_[outer] == k || round_body_[inner] == k;
  }
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
    if (occluder.round() || own(occluder, ends)) continue;
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
    // the silhouette of a round body makes events everywhere, each of them slight
    const bool round = !shadows_.turning.empty(), tight = tolerance <= cut_first * unhidden;
    const double allowed = tolerance * std::sqrt(share) * (round ? round_share : 1);
    HiddenIntegral integral;
    if (round || !tight) {
      integral = quadrature.kinked(std::span(&cell, 1), area(cell, normal), allowed,
                                   round && tight ? round_halvings : 0);
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
