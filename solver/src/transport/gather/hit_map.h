#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "luxel/patch_mesh.h"

namespace luxel {

/// From what a ray met (a triangle of the occluders, its side, barycentric coordinates) to the patch there,
/// by a picture of each polygon's side whose texels hold patch numbers: vector code can read it. Boundaries
/// between patches are blurred by a texel at most; where that could lose a whole patch, or where another
/// polygon stands between the two or lies in the same place, the texel says `ask`, and PatchLocator knows.
/// Patches in rows and columns are the texels themselves. Memory: 16 to 64 bytes a patch, 4 in rows and
/// columns, 32 a triangle.
class HitMap {
 public:
  static constexpr std::int32_t ask = -1;  ///< a texel that does not know

  /// Texel coordinates (x, y) = x0 + u xu + v xv, in the picture's size at most; texel first + y width + x of
  /// the front; the back's picture follows the front's, or stands in its place where there is no other.
  struct Triangle {
    float x0, xu, xv, y0, yu, yv;
    std::uint32_t size;  ///< width + height << size_bits, and the two flags
    std::int32_t first;
  };
  static constexpr int size_bits = 15;
  static constexpr std::uint32_t largest_size = (1u << size_bits) - 1;         ///< width and height at most
  static constexpr std::uint32_t front_side = 1u << 30, back_side = 1u << 31;  ///< there are patches on it

  explicit HitMap(const PatchMesh& mesh, double texels_a_patch = 16);

  /// Texels a patch that are worth having for so many rays from each.
  static double texels_for(int patches, int rays);

  /// What the map says of a hit: a patch, `ask`, or `off_patches` where that side has none.
  std::int32_t at(int triangle, bool front, float u, float v) const;
  static constexpr std::int32_t off_patches = -2;

  const std::vector<Triangle>& triangles() const { return triangles_; }
  /// All pictures, and behind them a texel that stands for whatever holds no patch.
  const std::vector<std::int32_t>& texels() const { return texels_; }
  std::int32_t nothing() const { return static_cast<std::int32_t>(texels_.size()) - 1; }
  std::size_t bytes() const {
    return triangles_.size() * sizeof(Triangle) + texels_.size() * sizeof(std::int32_t);
  }

 private:
  std::vector<Triangle> triangles_;
  std::vector<std::int32_t> texels_;
};

}  // namespace luxel
