#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "form_factors/hidden_pair.h"

// What of HiddenPair makes shadows of occluders.

namespace luxel {

namespace {

// Six times the volume of eye, edge (of length 1) and target is rounded by a few units in the last place of
// coordinates up to 1: below this an edge passes by.
constexpr double volume_rounding = 1e-14;

double side(const Span& span) {
  return span.high > -span.low ? span.high : span.low;
}

// Whether the cut lies on the edge's line, up to the distance at which a point lies on an occluder.
bool on_line(const ShadowEdge& edge, const ShadowEdge& cut) {
  const Vec3 along = (edge.q - edge.p).normalized();
  return std::max((cut.p - edge.p).cross(along).squaredNorm(), (cut.q - edge.p).cross(along).squaredNorm()) <=
         side_tolerance * side_tolerance;
}

}  // namespace

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

HiddenPair::Cast HiddenPair::cast_face(const Polygon& cell, const Ends& ends, const OccluderFace& face) {
  edges_.clear();
  cuts_.clear();
  const double height = side(span_along(cell, face.plane));
  if (std::abs(height) <= side_tolerance) return Cast::misses;
  const Plane seen = height > 0 ? face.plane : face.plane.flipped();
  const Span span = span_along(ends.target, seen);
  const double depth = touching_depth(*ends.inner);
  if (span.low >= -depth) return Cast::misses;
  if (span.high > depth) add_cut(cell, ends.target, seen);
  for (int k = 0; k < face.outline.count; ++k) {
    if (height > 0) {
      edges_.push_back({face.outline[k], face.outline.next(k)});
    } else {
      edges_.push_back({face.outline.next(k), face.outline[k]});
    }
  }
  return keep_relevant();
}

HiddenPair::Cast HiddenPair::cast_body(const Polygon& cell, const Ends& ends, const Occluder& body) {
  edges_.clear();
  cuts_.clear();
  const double depth = touching_depth(*ends.inner);
  unsigned front = 0;
  for (int k = 0; k < body.face_count(); ++k) {
    const Plane& plane = set_.faces[body.begin + k].plane;
    const double height = side(span_along(cell, plane));
    if (height <= side_tolerance) continue;
    front |= 1u << k;
    const Span span = span_along(ends.target, plane);
    if (span.low >= -depth) return Cast::misses;
    if (span.high > depth) add_cut(cell, ends.target, plane);
  }
  if (front == 0) return Cast::misses;
  for (const BodyEdge& edge : body.edges) {
    const bool left = front >> edge.face & 1u, right = front >> edge.neighbour & 1u;
    if (left && !right) edges_.push_back({edge.p, edge.q});
    if (right && !left) edges_.push_back({edge.q, edge.p});
  }
  return keep_relevant();
}

// Span of the volumes of an edge with all lines of sight: positive where they pass it on the inside.
Span HiddenPair::volumes(const ShadowEdge& edge) const {
  const Vec3 along = (edge.q - edge.p).normalized(), moment = edge.p.cross(along);
  Span span;
  for (std::size_t k = 0; k < lines_.size(); ++k) {
    const double volume = -(moment.dot(sights_[k]) + along.dot(lines_[k]));
    span.low = std::min(span.low, volume);
    span.high = std::max(span.high, volume);
  }
  return span;
}

// An edge matters where some line of sight passes it on the one side and some on the other.
HiddenPair::Cast HiddenPair::keep_relevant() {
  const std::size_t first = shadows_.edges.size();
  for (const ShadowEdge& edge : edges_) {
    const Span span = volumes(edge);
    if (span.high <= volume_rounding) {
      shadows_.edges.resize(first);
      return Cast::misses;
    }
    if (span.low < -volume_rounding) shadows_.edges.push_back(edge);
  }
  // where the face stands on the target, its edge and the cut by its plane are one line: it counts once
  const std::size_t first_cut = shadows_.edges.size();
  for (const ShadowEdge& cut : cuts_) {
    const bool known =
        std::any_of(shadows_.edges.begin() + static_cast<std::ptrdiff_t>(first), shadows_.edges.end(),
                    [&](const ShadowEdge& edge) { return on_line(edge, cut); });
    if (!known) shadows_.edges.push_back(cut);
  }
  if (shadows_.edges.size() == first) return Cast::everything;
  shadows_.begin.push_back(static_cast<int>(shadows_.edges.size()));
  shadows_.cut.push_back(shadows_.edges.size() > first_cut);
  return Cast::shadow;
}

// A round body hides what lies in its cone of sight where all of it is on this side of the target's plane:
// no line to the target then ends before it has met the body.
HiddenPair::Cast HiddenPair::cast_round(const Polygon& cell, const Occluder& body) {
  heights_.clear();
  for (int f = body.begin; f < body.end; ++f) heights_.push_back(span_along(cell, set_.faces[f].plane));
  const std::size_t first = shadows_.edges.size(), first_turning = shadows_.turning.size();
  const auto misses = [&] {
    shadows_.edges.resize(first);
    shadows_.turning.resize(first_turning);
    return Cast::misses;
  };
  for (const BodyEdge& edge : body.edges) {
    const Span &left = heights_[static_cast<std::size_t>(edge.face)],
               &right = heights_[static_cast<std::size_t>(edge.neighbour)];
    const bool forward = left.high > 0 && right.low <= 0, backward = right.high > 0 && left.low <= 0;
    if (!forward && !backward) continue;
    const ShadowEdge as_forward{edge.p, edge.q};
    const Span span = volumes(as_forward);
    const bool turns = !(left.low > 0 && right.high <= 0) && !(right.low > 0 && left.high <= 0);
    if (!turns && (forward ? span.high : -span.low) <= volume_rounding) return misses();
    const bool bounds = (forward && span.low < -volume_rounding) || (backward && span.high > volume_rounding);
    if (!bounds) continue;
    const auto number = static_cast<int>(shadows_.edges.size());
    if (turns) {
      shadows_.turning.push_back(
          {number, set_.faces[body.begin + edge.face].plane, set_.faces[body.begin + edge.neighbour].plane});
    }
    shadows_.edges.push_back(turns || forward ? as_forward : ShadowEdge{edge.q, edge.p});
  }
  if (shadows_.edges.size() == first) return Cast::everything;
  shadows_.begin.push_back(static_cast<int>(shadows_.edges.size()));
  shadows_.cut.push_back(0);
  return Cast::shadow;
}

HiddenPair::Cast HiddenPair::cast(const Polygon& cell, const Ends& ends, const Occluder& occluder) {
  if (!occluder.body()) return cast_face(cell, ends, set_.faces[occluder.begin]);
  if (!occluder.round()) return cast_body(cell, ends, occluder);
  const Side of_target = side_of_plane(occluder, ends.inner->plane);
  if (of_target == Side::behind) return Cast::misses;
  if (of_target == Side::front) return cast_round(cell, occluder);
  // the target's plane runs through the body: face by face
  Cast all = Cast::misses;
  for (int f = occluder.begin; f < occluder.end; ++f) {
    const Cast one = cast_face(cell, ends, set_.faces[f]);
    if (one == Cast::everything) return one;
    if (one == Cast::shadow) all = one;
  }
  return all;
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

}  // namespace luxel
