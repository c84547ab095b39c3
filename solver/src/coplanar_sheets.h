#pragma once

#include <span>
#include <vector>

#include "luxel/patch_mesh.h"

namespace luxel {

/// Which polygons of the occluders overlap a given one in its plane: a ray that meets one sheet of several
/// may be told of any. Cost of a look-up: constant; a polygon with many others on it has a grid over them.
class CoplanarSheets {
 public:
  struct Sheet {
    int polygon;
    bool opposed;  ///< its front looks the other way
  };

  /// `normals` are those of the polygons, of any length.
  CoplanarSheets(const Occluders& occluders, const std::vector<Vec3>& normals);

  /// The polygons that may cover this point of `polygon` as well: all that do, within `tolerance` of the
  /// scene's diagonal.
  std::span<const Sheet> at(int polygon, const Vec3& point) const;

  static constexpr double tolerance = 1e-6;

 private:
  /// Cells over a polygon's sheets, along two axes of space; a cell's list is that of list first_list + j nx
  /// + i.
  struct Grid {
    int axes[2];
    double low[2], cells_per_metre[2];
    int nx = 0, ny = 0;
    int first_list = 0;
  };

  void add_grid(int polygon, std::span<const Sheet> sheets, const Vec3& normal);

  std::vector<int> lists_;  // list k: sheets_[lists_[k]] .. sheets_[lists_[k + 1]]; the first ones by polygon
  std::vector<Sheet> sheets_;
  std::vector<int> grid_of_;  // of each polygon: its grid, or -1
  std::vector<Grid> grids_;
  std::vector<Vec3> low_, high_;  // of each polygon, while grids are made [m]
};

}  // namespace luxel
