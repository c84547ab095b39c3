#pragma once

#include <vector>

#include "luxel/scene.h"

namespace luxel {

/// The rays of a pinhole camera. Pixel (x, y) covers [x, x + 1] x [y, y + 1], y downwards from the top.
class ViewRays {
 public:
  /// @throws std::invalid_argument for a camera that gives no picture
  explicit ViewRays(const Camera& camera);

  /// Unit direction through a point of the picture [pixels].
  Vec3 direction(double x, double y) const;
  /// Unit direction that the camera looks along.
  const Vec3& forward() const { return forward_; }

 private:
  Vec3 forward_;
  Vec3 right_;     // one pixel to the right, at distance 1
  Vec3 down_;      // one pixel down, at distance 1
  Vec3 top_left_;  // the picture's corner, at distance 1
};

/// Offsets from a pixel's centre [pixels] for samples of equal weight: a Hammersley set bent so that its
/// density is a tent two pixels wide in each direction, the reconstruction filter. Every pixel takes the same
/// set, so that straight edges are drawn alike all along.
std::vector<Eigen::Vector2d> tent_samples(int count);

}  // namespace luxel
