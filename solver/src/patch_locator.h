#pragma once

#include <span>
#include <vector>

#include "coplanar_sheets.h"
#include "luxel/patch_mesh.h"
#include "luxel/ray_scene.h"

namespace luxel {

/// Which patch lies at a point of a polygon of the occluders, on the side asked for: the way from what a ray
/// met back to the patches. Sheets that coincide are told apart by the side; where polygons overlap in part,
/// either may be met and stands for both. Each side of each polygon has loose grids (Ulrich 2000), one for
/// each size of its patches: a patch stands in the cell that its middle lies in, cells are no smaller than
/// patches, so that four of them hold what may lie at a point. Cost: 30 ns a look-up in the caches, 0.2 us at
/// a million patches, 0.1 us a patch to make; memory about 50 bytes a patch and 16 a polygon.
class PatchLocator {
 public:
  /// The mesh must outlive the locator.
  explicit PatchLocator(const PatchMesh& mesh);

  /// The patch whose front is the `front` (or back) side of triangle `triangle` of mesh.occluders at `point`
  /// [m], or that of a polygon which overlaps it there, on the same side; or -1: that side is the back of
  /// whatever stands there. Points off every outline by less than 1e-6 of the scene's diagonal belong to the
  /// nearest patch.
  int patch_at(int triangle, bool front, const Vec3& point) const;
  /// The same for what many rays met, -1 for those that met nothing; memory is called for in time.
  /// @param points  where they met it [m]
  /// @throws std::invalid_argument if the lengths differ
  std::vector<int> patches_at(std::span<const RayScene::Hit> hits, std::span<const Vec3> points) const;

 private:
  /// A patch in its cell's coordinates: the cell is a unit square around the origin. Triangles repeat their
  /// last corner.
  struct Outline {
    float x[4], y[4];
    int patch;
  };
  /// Cell (i, j) holds the outlines cells[j nx + i] .. cells[j nx + i + 1].
  struct Grid {
    Vec3 origin, u, v;  // ((x - origin) . u, (x - origin) . v) is (i, j)
    int nx = 0, ny = 0;
    std::vector<int> cells;

    Eigen::Array2d at(const Vec3& point) const { return {(point - origin).dot(u), (point - origin).dot(v)}; }
    /// The cell that (i, j) lies in.
    Eigen::Array2i own_cell(const Eigen::Array2d& at) const;
    /// The first and the last cell along each axis that may hold what lies at (i, j).
    Eigen::Array2i first_cell(const Eigen::Array2d& at) const;
    Eigen::Array2i last_cell(const Eigen::Array2d& at) const;
    const int* cell(int i, int j) const { return &cells[static_cast<std::size_t>(j) * nx + i]; }
  };
  /// One side of a polygon: grids_[first] .. with `count` grids, or with none the patch `first`, or -1.
  struct Sheet {
    int first = -1, count = 0;
  };
  struct Box;

  int patch_on(const Sheet& sheet, const Vec3& point) const;
  const Sheet& sheet_of(int triangle, bool front) const {
    return sheets_[2 * mesh_.occluders.polygons[triangle] + (front ? 0 : 1)];
  }
  std::vector<Grid> grids_of(std::span<const int> patches, int first_outline);
  Grid grid_of(std::span<const Box> boxes, const Vec3& u, const Vec3& v, int first_outline);
  double depth(int patch, const Vec3& point) const;

  const PatchMesh& mesh_;
  double tolerance_ = 0;       // [m]
  std::vector<Sheet> sheets_;  // 2 polygon + (front ? 0 : 1)
  CoplanarSheets coplanar_;
  std::vector<Grid> grids_;
  std::vector<Outline> outlines_;
};

}  // namespace luxel
