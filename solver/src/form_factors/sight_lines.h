#pragma once

#include <array>
#include <cstdint>

#include "form_factors/cluster_tree.h"

namespace luxel {

/// A line of sight between two patches, in working coordinates.
struct SightLine {
  Vec3 from, to;      ///< a hair in front of their patches
  double weight = 0;  ///< of the exchange area's kernel, up to a factor of the pair; 0: the ends do not face
};

/// The line between a point of each of two patches.
SightLine sight_line(const WorkPatch& a, const Vec3& from, const WorkPatch& b, const Vec3& to);

/// Lines of sight of one pair: between two points each of a Sobol sequence in four dimensions, scrambled by
/// the seed and the pair. Holds pointers to the two patches.
class SightLines {
 public:
  SightLines(const WorkPatch& a, const WorkPatch& b, std::uint64_t seed);

  SightLine operator[](int k) const;

 private:
  const WorkPatch* a_;
  const WorkPatch* b_;
  const std::uint32_t* words_;
  std::uint64_t seed_;
  std::array<std::uint32_t, 4> seeds_;
};

/// Likewise between what each of the two sees of the other. Where neither straddles the other's plane these
/// are the patches themselves.
struct FacingParts {
  bool clipped = false;  ///< else the parts below are not filled
  WorkPatch a, b;
};
FacingParts facing_parts(const WorkPatch& a, const WorkPatch& b);

}  // namespace luxel
