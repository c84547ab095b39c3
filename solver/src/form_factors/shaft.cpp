#include "form_factors/shaft.h"

#include <algorithm>
#include <cmath>

namespace luxel {

namespace {

using Lanes = ShaftEnd::Lanes;

// Rounding of the products of two distances in working coordinates (coordinates up to 1, distances up to 2):
// a few units in the last place.
constexpr double product_rounding = 4e-15;

// A hull nearer to a face's plane than this lies in it: noise may put it on either side, so that the face is
// never taken to hide it as a whole.
constexpr double in_plane = 1e-8;

Lanes distances(const ShaftEnd& end, const Plane& plane) {
  return plane.normal.x() * end.x + plane.normal.y() * end.y + plane.normal.z() * end.z - plane.offset;
}

}  // namespace

ShaftEnd shaft_end(const Polygon& hull, const Vec3& centre, double radius, bool planar) {
  ShaftEnd end;
  end.planar = planar;
  end.count = std::min(hull.count, 8);
  for (int k = 0; k < 8; ++k) {
    const Vec3& corner = hull[std::min(k, end.count - 1)];
    end.x[k] = corner.x();
    end.y[k] = corner.y();
    end.z[k] = corner.z();
  }
  end.centre = centre;
  end.radius = radius;
  return end;
}

FaceInShaft face_in_shaft(const ShaftEnd& a, const ShaftEnd& b, const OccluderFace& face) {
  const Lanes sa = distances(a, face.plane), sb = distances(b, face.plane);
  const double a_low = sa.minCoeff(), a_high = sa.maxCoeff();
  const double b_low = sb.minCoeff(), b_high = sb.maxCoeff();
  FaceInShaft found;
  found.from_a = a_high > side_tolerance && b_low < -side_tolerance;
  found.from_b = b_high > side_tolerance && a_low < -side_tolerance;
  if (found.misses()) return found;

  const bool across = (a_low >= -side_tolerance && b_high <= side_tolerance) ||
                      (a_high <= side_tolerance && b_low >= -side_tolerance);
  const Lanes wa = sa.abs(), wb = sb.abs();
  const double wa_high = std::max(std::abs(a_low), std::abs(a_high));
  const double wb_high = std::max(std::abs(b_low), std::abs(b_high));
  const double rounding = product_rounding * (wa_high + wb_high);
  // what lies in the face's own plane is not hidden by it: a flat hull can only touch the plane, a solid one
  // may have patches in it
  const double wa_low = std::min(std::abs(a_low), std::abs(a_high));
  const double wb_low = std::min(std::abs(b_low), std::abs(b_high));
  bool hides = across && wa_high > in_plane && wb_high > in_plane && (a.planar || wa_low > side_tolerance) &&
               (b.planar || wb_low > side_tolerance);
  for (int edge = 0; edge < face.outline.count; ++edge) {
    const Lanes fa = distances(a, face.sides[edge]), fb = distances(b, face.sides[edge]);
    const bool outside = fa.maxCoeff() <= side_tolerance && fb.maxCoeff() <= side_tolerance;
    if (outside) return {};
    if (!across) continue;
    Lanes low = fa * wb[0] + fb[0] * wa, high = low;
    for (int k = 1; k < b.count; ++k) {
      const Lanes crossing = fa * wb[k] + fb[k] * wa;
      low = low.min(crossing);
      high = high.max(crossing);
    }
    if (high.maxCoeff() <= rounding) return {};
    hides = hides && low.minCoeff() >= -rounding;
  }
  found.hides = hides;
  return found;
}

bool sphere_in_shaft(const ShaftEnd& a, const ShaftEnd& b, const Vec3& centre, double radius) {
  // |c_a + t (c_b - c_a) - centre|^2 <= (r_a + t (r_b - r_a) + radius)^2 for some t in [0, 1]
  const Vec3 from = a.centre - centre, along = b.centre - a.centre;
  const double reach = a.radius + radius, growth = b.radius - a.radius;
  const double constant = from.squaredNorm() - reach * reach;
  const double linear = 2 * (from.dot(along) - reach * growth);
  const double square = along.squaredNorm() - growth * growth;
  if (constant <= 0 || constant + linear + square <= 0) return true;
  if (square <= 0 || linear >= 0 || -linear >= 2 * square) return false;
  return constant - linear * linear / (4 * square) <= 0;
}

namespace {

enum class RoundBody { misses, may_hide, hides };

// How a round body lies to the lines between two hulls: it hides them where its inner sphere meets each of
// them, and none where a plane across the shortest way to them has it on its other side.
RoundBody round_body_in_shaft(const ShaftEnd& a, const ShaftEnd& b, const Occluder& body) {
  const Vec3 along = b.centre - a.centre;
  const double square = along.squaredNorm();
  const double t = square > 0 ? std::clamp((body.centre - a.centre).dot(along) / square, 0.0, 1.0) : 0.5;
  const Vec3 aside = a.centre + t * along - body.centre;
  const double distance = aside.norm();
  if (distance + (1 - t) * a.radius + t * b.radius < body.inner_radius) return RoundBody::hides;
  if (!(distance > 0)) return RoundBody::may_hide;
  const Vec3 normal = aside / distance;
  const Plane plane{normal, normal.dot(body.centre)};
  const double nearest = std::min(distances(a, plane).minCoeff(), distances(b, plane).minCoeff());
  if (nearest <= 0) return RoundBody::may_hide;
  for (const Vec3& x : body.vertices) {
    if (plane.distance(x) > nearest) return RoundBody::may_hide;
  }
  return RoundBody::misses;
}

constexpr std::uint16_t all_faces = 0xffff;

}  // namespace

ShaftCandidates candidates_in_shaft(const ShaftEnd& a, const ShaftEnd& b, const OccluderSet& set,
                                    const std::vector<Candidate>& inherited) {
  ShaftCandidates found;
  for (const Candidate& candidate : inherited) {
    const Occluder& occluder = set.occluders[candidate.occluder];
    if (!sphere_in_shaft(a, b, occluder.centre, occluder.radius)) continue;
    if (occluder.round()) {
      const RoundBody body = round_body_in_shaft(a, b, occluder);
      if (body == RoundBody::hides) return {true, {}};
      if (body == RoundBody::may_hide) found.list.push_back(candidate);
      continue;
    }
    Candidate kept{candidate.occluder, 0, 0};
    const unsigned faces = candidate.from_a | candidate.from_b;
    for (int k = 0; k < occluder.face_count(); ++k) {
      const unsigned bit = 1u << k;
      if (!(faces & bit)) continue;
      const FaceInShaft face = face_in_shaft(a, b, set.faces[occluder.begin + k]);
      if (face.hides) return {true, {}};
      if (face.from_a) kept.from_a = static_cast<std::uint16_t>(kept.from_a | bit);
      if (face.from_b) kept.from_b = static_cast<std::uint16_t>(kept.from_b | bit);
    }
    // a line that meets a body sees the front of the face by which it enters, from either end
    const bool may_hide =
        occluder.body() ? kept.from_a != 0 && kept.from_b != 0 : (kept.from_a | kept.from_b) != 0;
    if (may_hide) found.list.push_back(kept);
  }
  return found;
}

std::vector<Candidate> all_candidates(const OccluderSet& set) {
  std::vector<Candidate> list;
  for (std::size_t k = 0; k < set.occluders.size(); ++k) {
    const Occluder& occluder = set.occluders[k];
    const auto mask =
        occluder.round() ? all_faces : static_cast<std::uint16_t>((1u << occluder.face_count()) - 1);
    list.push_back({static_cast<int>(k), mask, mask});
  }
  return list;
}

}  // namespace luxel
