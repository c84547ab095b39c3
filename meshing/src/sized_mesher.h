#pragma once

#include <limits>
#include <optional>

#include "longest_edge.h"
#include "luxel/progress.h"
#include "polygon_fill.h"

namespace luxel {

/// A scene's polygons and curved parts cut into triangles, which patches are made of.
struct Filled {
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> polygons;  ///< of each triangle
  bool graded = false;        ///< whether points were added for the sake of angles
  bool complete = true;       ///< whether these were enough
};

/// Cuts a scene into triangles of any size asked for.
class SizedMesher {
 public:
  /// `edges` are those of the facets; `guess` is about the edge length that will be asked for [m].
  SizedMesher(const Scene& scene, const Facets& facets, const EdgeTable& edges, double guess,
              double crease_angle);

  /// How many patches a sizing gives, about, before grading.
  double count(const Sizing& sizing);

  /// How many patches a fill gives.
  double count(const Filled& filled) const;

  /// Edges are graded where that is needed for angles of `smallest_angle` [radians].
  Filled fill(const Sizing& sizing, double smallest_angle, const Progress& progress);

  const SurfacePlan& plan() const { return plan_; }

 private:
  double sides(int p) const;
  LongestEdgeRefiner halving(std::vector<Vec3>& vertices) const;
  std::size_t halvings(const Sizing& sizing);

  const Facets& facets_;
  SurfacePlan plan_;
  std::vector<Vec3> trial_vertices_;
  std::optional<LongestEdgeRefiner> trial_;
  double finest_ = std::numeric_limits<double>::infinity();  // longest edge of the trial
  double sides_of_halved_ = 1;
};

}  // namespace luxel
