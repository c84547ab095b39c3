#pragma once

#include <cstdint>
#include <vector>

#include "transport/gather/lamps.h"
#include "transport/gather/patch_frame.h"

namespace luxel {

/// How much of a lamp a patch sees, by rays.
struct LampView {
  double share = 0;                            ///< of the unoccluded light that arrives
  int rays = 0;                                ///< cast
  bool some_lit = false, some_hidden = false;  ///< of these
};

/// Whether a lamp is so near, or touches, that some of the patch may see what a few rays do not.
bool is_close(const PatchFrame& patch, const Lamp& lamp);

/// Rays between quasi-random points of a patch and a lamp. Immutable.
class ShadowRays {
 public:
  /// @param most  rays of one view at most
  ShadowRays(const RayScene& occluders, int most);

  /// The share of `lamp` that a patch sees, by about `count` rays: points of the lamp's frame that are off it
  /// cost none. Rays weigh what they would carry; as many again are drawn by the cosine where lamps are
  /// close.
  LampView view(const PatchFrame& patch, const Lamp& lamp, int count, std::uint64_t seed) const;

 private:
  void* scene_;
  std::vector<std::uint32_t> words_;
};

}  // namespace luxel
