#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "transport/gather/hit_map.h"
#include "transport/gather/plane_picture.h"

namespace luxel {

namespace {

// Corners this far from those of their cell [cells] are in them: above what files round, far below what a
// picture of other patches blurs.
constexpr double misplacement = 1e-3;

// Cells for each patch, at most.
constexpr double most_emptiness = 4;

// Patches below which a picture is small anyhow.
constexpr std::size_t least_patches = 4;

/// Whether a patch is the cell with this lowest corner, its own corners in either order.
bool is_cell(const PatchMesh& mesh, int patch, const PlanePicture& picture, const Eigen::Array2d& cell) {
  if (mesh.corner_count(patch) != 4) return false;
  unsigned met = 0;
  for (const int corner : mesh.corners[patch]) {
    const Eigen::Array2d at = picture.at(mesh.vertices[corner]).array() - cell;
    const Eigen::Array2d nearest = at.round();
    if ((at - nearest).abs().maxCoeff() > misplacement) return false;
    if (nearest.minCoeff() < 0 || nearest.maxCoeff() > 1) return false;
    met |= 1u << static_cast<int>(nearest[0] + 2 * nearest[1]);
  }
  return met == 0xf;
}

std::size_t texel_of(const PatchMesh& mesh, int patch, const PlanePicture& picture) {
  const Eigen::Vector2d at = picture.at(mesh.centroids[patch]);
  return static_cast<std::size_t>(at[1]) * picture.width + static_cast<std::size_t>(at[0]);
}

}  // namespace

std::optional<PlanePicture> grid_picture(const PatchMesh& mesh, std::span<const int> triangles,
                                         std::span<const int> patches) {
  if (patches.size() < least_patches || mesh.corner_count(patches[0]) != 4) return {};
  const auto& corners = mesh.corners[patches[0]];
  PlanePicture picture;
  picture.grid = true;
  picture.origin = mesh.vertices[corners[0]];
  const Vec3 x = mesh.vertices[corners[1]] - picture.origin, y = mesh.vertices[corners[3]] - picture.origin;
  const Vec3 normal = x.cross(y);
  if (!(normal.squaredNorm() > 0)) return {};
  picture.along_x = y.cross(normal) / normal.squaredNorm();
  picture.along_y = normal.cross(x) / normal.squaredNorm();
  Eigen::Array2d low(0, 0), high(1, 1);
  for (const int patch : patches) {
    const Eigen::Array2d cell = picture.at(mesh.centroids[patch]).array().floor();
    if (!is_cell(mesh, patch, picture, cell)) return {};
    low = low.min(cell);
    high = high.max(cell + 1);
  }
  const Eigen::Array2d size = high - low;
  if (size.maxCoeff() > HitMap::largest_size) return {};
  if (size.prod() > most_emptiness * static_cast<double>(patches.size())) return {};
  picture.origin += low[0] * x + low[1] * y;
  picture.width = static_cast<int>(size[0]);
  picture.height = static_cast<int>(size[1]);
  // whatever can be met lies in the picture
  for (const int t : triangles) {
    for (const int corner : mesh.occluders.triangles[t]) {
      const Eigen::Array2d at = picture.at(mesh.occluders.vertices[corner]).array();
      if ((at < -misplacement).any() || (at > size + misplacement).any()) return {};
    }
  }
  std::vector<bool> taken(picture.texels(), false);
  for (const int patch : patches) {
    const std::size_t texel = texel_of(mesh, patch, picture);
    if (taken[texel]) return {};
    taken[texel] = true;
  }
  return picture;
}

void draw_grid(const PatchMesh& mesh, std::span<const int> patches, const PlanePicture& picture,
               std::span<std::int32_t> texels) {
  std::fill(texels.begin(), texels.end(), HitMap::ask);
  for (const int patch : patches) texels[texel_of(mesh, patch, picture)] = patch;
}

}  // namespace luxel
