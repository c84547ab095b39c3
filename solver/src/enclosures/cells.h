#pragma once

#include <vector>

#include "enclosures/shells.h"
#include "enclosures/triangle_soup.h"
#include "luxel/patch_mesh.h"
#include "luxel/ray_scene.h"

namespace luxel {

/// Looking for contacts takes time above proportion to the triangles; beyond these (curved meshes) nothing is
/// proven.
inline constexpr int most_proven_triangles = 30'000;

/// What the connections of the surfaces prove about the space that a patch looks into.
enum class Proof {
  none,    ///< nothing: rims, contacts or crossings blur it
  closed,  ///< bounded, and patches show their fronts all around: no direction escapes or meets a back
  open     ///< unbounded, or some back shows
};

/// The pieces that the occluders cut space into, as far as they can be told apart by index.
struct Cells {
  std::vector<int> cell;     ///< for each side of a triangle
  std::vector<Proof> proof;  ///< for each cell
  int count = 0;
};

/// Volume on the far side of each shell's free space, in working units: negative where the shell goes around
/// it.
std::vector<double> shell_volumes(const TriangleSoup& soup, const Shells& shells);

/// @param lit  for each side of a triangle: patches cover it
/// A shell of negative volume goes around its cell; any other floats in a cell whose other shells are what is
/// seen from it: three rays a shell, more where it sees only itself.
Cells find_cells(const TriangleSoup& soup, const Shells& shells, const std::vector<char>& lit,
                 const RayScene& scene);

/// For each side of a triangle of the occluders whether patches cover it wholly: by the areas of its polygon.
std::vector<char> lit_sides(const PatchMesh& mesh);

/// The cell that each patch looks into; -1 where its polygon's side bounds several.
std::vector<int> cells_of_patches(const PatchMesh& mesh, const Cells& cells);

}  // namespace luxel
