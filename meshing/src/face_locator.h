#pragma once

#include <span>

#include "box_tree.h"
#include "facets.h"
#include "flat_polygons.h"

namespace luxel {

/// Tells which of the facets of one flat polygon a point of it lies in. Cost: log of the number of facets.
class FaceLocator {
 public:
  FaceLocator(const Facets& facets, std::span<const int> members, const Frame& frame);

  /// The scene's face at the point; the nearest one where rounding puts it beside all.
  int face_at(const Vec3& point) const;

 private:
  const Facets& facets_;
  std::span<const int> members_;
  Frame frame_;
  double reach_;  // half the width of the boxes that are looked through [m]
  BoxTree tree_;
};

}  // namespace luxel
