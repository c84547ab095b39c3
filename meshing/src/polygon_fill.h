#pragma once

#include "lattice.h"
#include "surface_plan.h"
#include "triangulate.h"

namespace luxel {

/// A polygon cut into triangles.
struct PolygonFill {
  int polygon;
  std::vector<int> inside;  ///< its vertices that lie on no edge of the plan
  std::vector<std::array<int, 3>> triangles;
};

/// A polygon in its plane, with the points that its edges are divided by.
struct PolygonDomain {
  PlanarDomain domain;
  std::vector<int> vertices;  ///< for each point of the domain
  std::vector<int> edges;     ///< for each part of the borders, then of the creases, its edge in the plan
};

/// Fills the flat polygons of a plan with triangles.
class PolygonFiller {
 public:
  PolygonFiller(const std::vector<Vec3>& corners, const SurfacePlan& plan) : corners_(corners), plan_(plan) {}

  /// How many triangles fill(p) will make, all edges divided evenly.
  double count(int p, const Sizing& sizing) const;

  /// Triangles over `vertices`, to which points inside are appended; the plan's edges are divided already.
  PolygonFill fill(int p, const Sizing& sizing, std::vector<Vec3>& vertices);

  /// The same polygon cut anew, after points were added to its edges or inside.
  PolygonFill refill(PolygonFill fill, const std::vector<Vec3>& vertices);

  PolygonDomain domain(int p, const std::vector<int>& inside, const std::vector<Vec3>& vertices);

 private:
  using Part = std::array<Vec2, 2>;

  void divide(const Frame& frame, int a, int b, const Sizing& sizing, std::vector<Part>& parts) const;
  Part longest_side(int p) const;

  const std::vector<Vec3>& corners_;  // the facets' vertices
  const SurfacePlan& plan_;
  std::vector<int> place_;  // of a vertex in the domain at hand; -1: not in it
};

}  // namespace luxel
