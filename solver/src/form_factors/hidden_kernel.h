#pragma once

#include <cstddef>
#include <vector>

#include "form_factors/polygon.h"

namespace luxel {

/// Points of the outer patch of a pair, in columns.
struct OuterPoints {
  std::vector<double> x, y, z, weight;

  std::size_t size() const { return x.size(); }
  void clear();
  void add(const Vec3& point, double point_weight);
};

/// An edge of a shadow: the plane through the eye and the line p-q bounds what is hidden, which lies on the
/// side where ((q - x) x (p - x)) . y >= 0.
struct ShadowEdge {
  Vec3 p, q;
};

/// The faces on both sides of an edge of a round body: the edge belongs to the silhouette as seen from eyes
/// that are in front of one of them only, and bounds what is hidden as p-q seen by those in front of `left`,
/// as q-p by the others.
struct Turning {
  int edge = 0;  ///< in Shadows::edges
  Plane left, right;
};

/// Convex cones of sight that occluders block, as seen from any point of one cell of the outer patch: cone k
/// is bounded by edges [begin[k], begin[k + 1]). Edges that never cross the inner patch are left out; a cone
/// has at least one edge.
struct Shadows {
  std::vector<ShadowEdge> edges;
  std::vector<int> begin{0};
  std::vector<char> cut;  ///< per cone: one of its edges is a cut by a face's plane, so that it must be
                          ///< clipped by its own edges too
  std::vector<Turning> turning;   ///< by edge; the other edges bound the same side for every eye
  std::vector<signed char> ties;  ///< edges x edges, see tie(); empty for one cone

  /// How two edges of different cones lie for every eye: 0 apart, +1 on one line with the same side inside,
  /// -1 on one line with opposite sides inside.
  int tie(int e, int o) const {
    return ties[static_cast<std::size_t>(e) * edges.size() + static_cast<std::size_t>(o)];
  }
  int count() const { return static_cast<int>(begin.size()) - 1; }
  void clear();
};

/// Fills `ties`: which edges of different cones lie on one line in space.
void find_ties(Shadows& shadows);

/// What one call of hidden_shares works in; kept between calls to save its allocation.
class HiddenWorkspace {
 public:
  /// At least `size` doubles, aligned for any vector; valid until the next call.
  double* reserve(std::size_t size);

 private:
  std::vector<double> memory_;
};

/// For each point x: the share of the flux of an infinitesimal patch at x with `normal` that would arrive at
/// the inner polygon, and that the union of the shadows hides. Exact up to rounding (Lambert 1760 around the
/// boundary of the hidden region): each edge's visible part is its line's interval within the inner polygon
/// less the union of the intervals that other cones cover, so that the cost grows with edges squared and not
/// with subsets of cones. The points lie in front of the inner polygon and it in front of them.
/// A point in one plane with edges of two cones that are no tie may see their order wrong by rounding: keep
/// points off symmetric places.
/// @param inner  counter-clockwise seen from the points
void hidden_shares(const OuterPoints& points, const Vec3& normal, const Polygon& inner,
                   const Shadows& shadows, HiddenWorkspace& workspace, std::vector<double>& shares);

}  // namespace luxel
