#include "plan/dark_enclosures.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>

#include "enclosures/cells.h"
#include "enclosures/shells.h"
#include "enclosures/triangle_soup.h"
#include "luxel/solve.h"
#include "plan/decisions.h"

namespace luxel {

namespace {

/// What the patches on either side of each polygon are like; side_of() counts the sides of polygons.
struct PolygonSides {
  std::vector<int> of_patch;
  std::vector<char> covered;   ///< some patch lies on it
  std::vector<char> emitting;  ///< some patch on it emits

  PolygonSides(const PatchMesh& mesh, const PatchField& emission) {
    const Occluders& occluders = mesh.occluders;
    std::vector<Vec3> normals(occluders.polygon_count, Vec3::Zero());
    for (std::size_t t = 0; t < occluders.triangles.size(); ++t) {
      const auto& [a, b, c] = occluders.triangles[t];
      const Vec3& origin = occluders.vertices[a];
      normals[occluders.polygons[t]] +=
          (occluders.vertices[b] - origin).cross(occluders.vertices[c] - origin);
    }
    of_patch.resize(mesh.size());
    covered.assign(2 * normals.size(), 0);
    emitting.assign(2 * normals.size(), 0);
    for (int i = 0; i < mesh.size(); ++i) {
      const int polygon = mesh.polygons[i];
      const int side = of_patch[i] = side_of(polygon, mesh.normals[i].dot(normals[polygon]) > 0);
      covered[side] = 1;
      if ((emission.row(i).array() > 0).any()) emitting[side] = 1;
    }
  }
};

/// The side of a polygon that a side of one of its triangles belongs to.
int polygon_side(const Occluders& occluders, std::size_t side) {
  return side_of(occluders.polygons[side / 2], side % 2 == 0);
}

/// Whether some shell might go around a dark enclosure, as far as can be told without looking for contacts.
bool may_be_dark(const Occluders& occluders, const TriangleSoup& soup, const Shells& shells,
                 const PolygonSides& sides) {
  const std::vector<double> volume = shell_volumes(soup, shells);
  std::vector<char> covered(shells.count, 0), lit(shells.count, 0);
  for (std::size_t s = 0; s < shells.shell.size(); ++s) {
    const int side = polygon_side(occluders, s);
    covered[shells.shell[s]] |= sides.covered[side];
    lit[shells.shell[s]] |= sides.emitting[side];
  }
  for (const Rim& rim : shells.rims) lit[shells.shell[side_of(rim.triangle, true)]] = 1;
  for (int k = 0; k < shells.count; ++k) {
    if (covered[k] && !lit[k] && volume[k] < 0) return true;
  }
  return false;
}

/// For each cell whether it is closed and light comes from nowhere.
std::vector<char> dark_cells(const PatchMesh& mesh, const Cells& cells, const std::vector<int>& cell,
                             const PolygonSides& sides) {
  // what a patch brings that looks into several cells is not followed
  std::vector<char> bright = sides.emitting;
  for (int i = 0; i < mesh.size(); ++i) {
    if (cell[i] < 0) bright[sides.of_patch[i]] = 1;
  }
  std::vector<char> dark(cells.count);
  for (int c = 0; c < cells.count; ++c) dark[c] = cells.proof[c] == Proof::closed;
  for (std::size_t s = 0; s < cells.cell.size(); ++s) {
    if (bright[polygon_side(mesh.occluders, s)]) dark[cells.cell[s]] = 0;
  }

  const PatchField rho = reflectance(mesh);
  std::vector<std::array<char, 3>> absorbs(cells.count, {0, 0, 0});
  for (int i = 0; i < mesh.size(); ++i) {
    if (cell[i] < 0) continue;
    for (int c = 0; c < 3; ++c) absorbs[cell[i]][c] |= rho(i, c) < 1 - smallest_loss;
  }
  for (int c = 0; c < cells.count; ++c) {
    const auto& channels = absorbs[c];
    if (!(channels[0] && channels[1] && channels[2])) dark[c] = 0;
  }
  return dark;
}

}  // namespace

DarkEnclosures dark_enclosures(const PatchMesh& mesh, const RayScene& occluders) {
  if (mesh.occluders.triangles.size() > most_proven_triangles) return {};
  const PolygonSides sides(mesh, emission(mesh));
  const TriangleSoup soup(mesh.occluders, occluders);
  const Shells shells = find_shells(soup);
  if (!may_be_dark(mesh.occluders, soup, shells, sides)) return {};
  const Cells cells = find_cells(soup, shells, lit_sides(mesh), occluders);
  const std::vector<int> cell = cells_of_patches(mesh, cells);
  const std::vector<char> dark = dark_cells(mesh, cells, cell, sides);

  DarkEnclosures result;
  result.others_closed = true;
  std::vector<int> number(cells.count, -1);
  for (int i = 0; i < mesh.size(); ++i) {
    const int c = cell[i];
    if (c >= 0 && dark[c]) {
      if (number[c] < 0) number[c] = result.count++;
      result.enclosure.push_back(number[c]);
      ++result.patches;
    } else {
      result.enclosure.push_back(-1);
      result.others.push_back(i);
      result.others_closed &= c >= 0 && cells.proof[c] == Proof::closed;
    }
  }
  return result;
}

}  // namespace luxel
