#pragma once

#include "polygon_fill.h"

namespace luxel {

/// Fills after grading.
struct GradedFills {
  std::vector<PolygonFill> fills;
  std::size_t added = 0;  ///< points
  bool complete = true;   ///< false: too many points would have been needed
};

/// Adds points to fills with angles below `smallest_angle` [radians], inside and on edges that no halved
/// triangle shares, until there are none but for corners of the scene that are sharper: edge lengths then
/// follow the width of the polygons. A point on an edge goes to all polygons there. New vertices are appended
/// to `vertices`.
GradedFills grade(std::vector<PolygonFill> fills, double smallest_angle, SurfacePlan& plan,
                  PolygonFiller& filler, std::vector<Vec3>& vertices);

}  // namespace luxel
