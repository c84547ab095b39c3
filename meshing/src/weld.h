#pragma once

#include <vector>

#include "luxel/scene.h"

namespace luxel {

/// A scene's vertices with those that stand at the same place made one.
struct WeldedVertices {
  std::vector<Vec3> positions;  ///< [m], in order of first use by a face
  std::vector<int> index;  ///< for each vertex of the scene its place in `positions`; -1: no face uses it
  int welded = 0;          ///< used vertices that were joined to another one
};

/// Joins vertices nearer than 1e-8 of the scene's diagonal (and never less than the rounding of their
/// coordinates), but never over more than 1e-3 of the shortest edge that meets there: small bodies in a large
/// scene keep their shape. The first position stays. Cost: linear.
WeldedVertices weld(const Scene& scene);

/// Length of the diagonal of the box around the points [m].
double diagonal(const std::vector<Vec3>& points);

}  // namespace luxel
