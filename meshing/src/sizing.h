#pragma once

#include <limits>
#include <vector>

namespace luxel {

/// The edge lengths that a surface is cut by. One does for all its parts, as a rule. Where many parts are
/// alike and would all take one patch more at the same length, a share of them takes a shorter one; what then
/// is missing from the number asked for, or too much, edges make up by one part more or fewer.
struct Sizing {
  double edge_length = 0;  ///< [m]
  double finer = 0;        ///< [m], <= edge_length
  double share = 0;        ///< 0 .. 1, of the parts that are cut by `finer`
  double trim = 0;         ///< -1 .. 1, share of the edges that take one part more, or fewer where negative

  double longest = std::numeric_limits<double>::infinity();  ///< [m], of a part of an edge

  /// The edge length of a part whose turn is `turn`.
  double at(double turn) const { return turn < share ? finer : edge_length; }

  /// Into how many parts an edge of this length [m] is divided, whose turn is `turn`.
  int parts(double length, double turn) const;
};

/// When, in [0, 1), the polygons and edges of a surface take the finer length as its share grows.
struct Turns {
  std::vector<double> of_polygon;
  std::vector<double> of_edge;
};

/// Polygons take turns evenly over the list `polygons`, which is in the order of their places, so that those
/// with the finer length are scattered; each right after the edges around it that have not had theirs:
/// edges_of[k] are those of polygons[k]. Polygons that are not listed have no turn: 1.
Turns take_turns(const std::vector<int>& polygons, const std::vector<std::vector<int>>& edges_of,
                 int polygon_count, int edge_count);

/// The places 0 .. count - 1 in an order in which each stretch from the start on is spread over all of them.
std::vector<int> scattered_order(int count);

}  // namespace luxel
