#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "form_factors/occluder_set.h"

namespace luxel {

/// The corners of a convex hull, three to eight, in lanes; the last one fills the rest.
struct ShaftEnd {
  using Lanes = Eigen::Array<double, 8, 1>;
  Lanes x, y, z;
  int count = 0;
  bool planar = true;          ///< the hull of patches in one plane
  Vec3 centre = Vec3::Zero();  ///< of a sphere around the hull
  double radius = 0;
};

ShaftEnd shaft_end(const Polygon& hull, const Vec3& centre, double radius, bool planar = true);

/// How an occluder's face lies to the lines of sight between two hulls.
struct FaceInShaft {
  bool from_a = false;  ///< a line may pass it from the front, seen from a
  bool from_b = false;  ///< or seen from b
  bool hides = false;   ///< every line passes through it
  bool misses() const { return !from_a && !from_b; }
};

/// Division-free test on the corners of both hulls: with s the distances from the face's plane and f those
/// from the side of an edge, the line from x to y crosses the plane inside of the edge where f_x |s_y| + f_y
/// |s_x| >= 0, and that is bilinear in x and y. Sound both ways, up to rounding: a face that misses hides
/// nothing, one that hides leaves nothing.
FaceInShaft face_in_shaft(const ShaftEnd& a, const ShaftEnd& b, const OccluderFace& face);

/// Whether the sphere may meet a line between the spheres around a and b.
bool sphere_in_shaft(const ShaftEnd& a, const ShaftEnd& b, const Vec3& centre, double radius);

/// An occluder that may hide something between two clusters, with those of its faces that do.
struct Candidate {
  int occluder = 0;
  std::uint16_t from_a = 0;  ///< faces that may be met from their front, seen from a: bit k = face begin + k;
                             ///< all bits for a round body
  std::uint16_t from_b = 0;
};

/// The candidates between a and b among those of a pair of clusters that holds them. `hidden`: one alone
/// hides all of b from all of a.
struct ShaftCandidates {
  bool hidden = false;
  std::vector<Candidate> list;
};
ShaftCandidates candidates_in_shaft(const ShaftEnd& a, const ShaftEnd& b, const OccluderSet& set,
                                    const std::vector<Candidate>& inherited);

/// Every occluder with every face: the list to begin with.
std::vector<Candidate> all_candidates(const OccluderSet& set);

}  // namespace luxel
