#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "luxel/patch_mesh.h"

namespace luxel {

/// The frame of a picture of one flat polygon, in texels.
struct PlanePicture {
  Vec3 origin = Vec3::Zero();
  Vec3 along_x = Vec3::Zero(), along_y = Vec3::Zero();  ///< texels a metre
  int width = 1, height = 1;                            ///< HitMap::largest_size at most
  bool grid = false;                                    ///< a texel a patch
  std::size_t texels() const { return static_cast<std::size_t>(width) * height; }

  Eigen::Vector2d at(const Vec3& point) const {
    return {(point - origin).dot(along_x), (point - origin).dot(along_y)};
  }
};

/// The smallest of the boxes around a polygon that have a side along one of its edges, with about `texels`
/// texels inside the polygon. Where the box is mostly empty: one texel only.
/// @param triangles  of the occluders, that the polygon is made of
/// @param front      its normal, of any length but 0
PlanePicture plane_picture(const Occluders& occluders, std::span<const int> triangles, const Vec3& front,
                           double texels);

/// The picture whose texels are the patches of a polygon's side, one each, where they are equal
/// parallelograms in rows and columns: it knows their boundaries exactly. Else nothing.
std::optional<PlanePicture> grid_picture(const PatchMesh& mesh, std::span<const int> triangles,
                                         std::span<const int> patches);

/// Writes each patch into its texel of their grid_picture(), and HitMap::ask into texels without a patch.
void draw_grid(const PatchMesh& mesh, std::span<const int> patches, const PlanePicture& picture,
               std::span<std::int32_t> texels);

/// Writes into each texel the patch at some point of it, so that patches have their share of the texels on
/// edges; beside the outline the nearest; and HitMap::ask where that would leave some patch without a texel,
/// or where nothing is near.
void draw_patches(const PatchMesh& mesh, std::span<const int> patches, const PlanePicture& picture,
                  std::span<std::int32_t> texels);

/// Writes HitMap::ask into each texel that the segment between two points crosses.
void draw_doubt(const PlanePicture& picture, const Vec3& from, const Vec3& to,
                std::span<std::int32_t> texels);

}  // namespace luxel
