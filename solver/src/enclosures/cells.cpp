#include "enclosures/cells.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "enclosures/contacts.h"
#include "enclosures/union_find.h"

namespace luxel {

namespace {

// A side is covered when its patches have its area within this share: above rounding, below a slit of 1e-6.
constexpr double covered_within = 1e-7;

Vec3 area_vector(const Vec3& a, const Vec3& b, const Vec3& c) {
  return (b - a).cross(c - a) / 2;
}

constexpr int nothing = -1;

/// The shells that three rays from the middle of a side meet, `nothing` among them where one escapes.
std::array<int, 3> seen_shells(const TriangleSoup& soup, const Shells& shells, const RayScene& scene,
                               int side) {
  const int triangle = side / 2;
  const Vec3 a = soup.corner(triangle, 0), b = soup.corner(triangle, 1), c = soup.corner(triangle, 2);
  const Vec3 normal = (side % 2 == 0 ? 1 : -1) * area_vector(a, b, c).normalized();
  const Vec3 middle = (a + b + c) / 3 / scene.scale() + scene.centre();
  const Vec3 tangent = normal.unitOrthogonal(), bitangent = normal.cross(tangent);
  // oblique, so that none runs along an axis
  const std::array<Vec3, 3> directions{(normal + 0.31 * tangent + 0.17 * bitangent).normalized(),
                                       (normal - 0.23 * tangent + 0.29 * bitangent).normalized(),
                                       (normal + 0.07 * tangent - 0.37 * bitangent).normalized()};
  const std::array<Vec3, 3> origins{middle, middle, middle}, normals{normal, normal, normal};
  std::array<RayScene::Hit, 3> hits;
  scene.intersect(origins, normals, directions, hits, RayScene::Look::once);
  std::array<int, 3> seen;
  for (int k = 0; k < 3; ++k) {
    seen[k] = hits[k].primitive < 0 ? nothing : shells.shell[side_of(hits[k].primitive, hits[k].front)];
  }
  return seen;
}

/// The sides of each shell together, the largest first; begins[k] is where shell k's begin.
struct SidesByShell {
  std::vector<int> sides;
  std::vector<int> begins;
};

SidesByShell sides_by_shell(const TriangleSoup& soup, const Shells& shells) {
  std::vector<double> area(soup.size());
  for (int t = 0; t < soup.size(); ++t) {
    area[t] = area_vector(soup.corner(t, 0), soup.corner(t, 1), soup.corner(t, 2)).norm();
  }
  SidesByShell result;
  result.sides.resize(shells.shell.size());
  std::iota(result.sides.begin(), result.sides.end(), 0);
  std::sort(result.sides.begin(), result.sides.end(), [&](int a, int b) {
    if (shells.shell[a] != shells.shell[b]) return shells.shell[a] < shells.shell[b];
    return area[a / 2] != area[b / 2] ? area[a / 2] > area[b / 2] : a < b;
  });
  for (int i = 0; i < static_cast<int>(result.sides.size()); ++i) {
    if (i == 0 || shells.shell[result.sides[i]] != shells.shell[result.sides[i - 1]])
      result.begins.push_back(i);
  }
  result.begins.push_back(static_cast<int>(result.sides.size()));
  return result;
}

/// Joins the shells that bound one cell together; entry shells.count stands for the space outside everything.
/// A shell that goes around its cell, and is not blurred, needs no rays: what floats inside is joined to it.
/// @return false where some shell sees nothing but itself, and so its place is not known
bool join_nested(const TriangleSoup& soup, const Shells& shells, const RayScene& scene,
                 const std::vector<char>& blurred, UnionFind& cells) {
  const std::vector<double> volume = shell_volumes(soup, shells);
  const SidesByShell order = sides_by_shell(soup, shells);
  for (int k = 0; k < shells.count; ++k) {
    if (!blurred[k] && volume[k] < 0) continue;
    bool placed = false;
    for (int i = order.begins[k]; i < order.begins[k + 1] && !placed; ++i) {
      for (int seen : seen_shells(soup, shells, scene, order.sides[i])) {
        if (seen == k) continue;
        cells.join(k, seen == nothing ? shells.count : seen);
        placed = true;
      }
    }
    if (!placed) return false;
  }
  return true;
}

}  // namespace

std::vector<double> shell_volumes(const TriangleSoup& soup, const Shells& shells) {
  std::vector<double> volume(shells.count, 0.0);
  for (int t = 0; t < soup.size(); ++t) {
    const double cone = soup.corner(t, 0).dot(soup.corner(t, 1).cross(soup.corner(t, 2))) / 6;
    volume[shells.shell[side_of(t, true)]] += cone;
    volume[shells.shell[side_of(t, false)]] -= cone;
  }
  return volume;
}

std::vector<char> lit_sides(const PatchMesh& mesh) {
  const Occluders& occluders = mesh.occluders;
  std::vector<Vec3> areas(occluders.polygon_count, Vec3::Zero());
  for (std::size_t t = 0; t < occluders.triangles.size(); ++t) {
    const auto& [a, b, c] = occluders.triangles[t];
    areas[occluders.polygons[t]] +=
        area_vector(occluders.vertices[a], occluders.vertices[b], occluders.vertices[c]);
  }
  std::vector<std::array<double, 2>> covered(occluders.polygon_count, {0, 0});
  for (int i = 0; i < mesh.size(); ++i) {
    const int p = mesh.polygons[i];
    covered[p][mesh.normals[i].dot(areas[p]) > 0 ? 0 : 1] += mesh.areas[i];
  }
  std::vector<char> lit(2 * occluders.triangles.size());
  for (std::size_t s = 0; s < lit.size(); ++s) {
    const int p = occluders.polygons[s / 2];
    lit[s] = covered[p][s % 2] >= (1 - covered_within) * areas[p].norm();
  }
  return lit;
}

Cells find_cells(const TriangleSoup& soup, const Shells& shells, const std::vector<char>& lit,
                 const RayScene& scene) {
  const bool examined = soup.size() <= most_proven_triangles;
  std::vector<char> blurred(shells.count, !examined);
  for (const Rim& rim : shells.rims) blurred[shells.shell[side_of(rim.triangle, true)]] = 1;
  if (examined) {
    const std::vector<char> touched = contacts(soup);
    for (std::size_t s = 0; s < shells.shell.size(); ++s) {
      if (touched[s / 2]) blurred[shells.shell[s]] = 1;
    }
  }

  UnionFind cells(shells.count + 1);
  const bool all_placed = examined && join_nested(soup, shells, scene, blurred, cells);

  Cells result;
  std::vector<int> number(shells.count + 1);
  for (int k = 0; k <= shells.count; ++k) {
    const int root = cells.root(k);
    number[k] = root == k ? result.count++ : number[root];
  }
  result.proof.assign(result.count, Proof::closed);
  result.proof[number[shells.count]] = Proof::open;
  result.cell.resize(shells.shell.size());
  for (std::size_t s = 0; s < shells.shell.size(); ++s) {
    result.cell[s] = number[shells.shell[s]];
    if (!lit[s]) result.proof[result.cell[s]] = Proof::open;
  }
  for (int k = 0; k < shells.count; ++k) {
    if (blurred[k] || !all_placed) result.proof[number[k]] = Proof::none;
  }
  return result;
}

std::vector<int> cells_of_patches(const PatchMesh& mesh, const Cells& cells) {
  const Occluders& occluders = mesh.occluders;
  constexpr int none = -2, several = -1;
  std::vector<std::array<int, 2>> of_polygon(occluders.polygon_count, {none, none});
  std::vector<Vec3> normals(occluders.polygon_count, Vec3::Zero());
  for (std::size_t t = 0; t < occluders.triangles.size(); ++t) {
    const int p = occluders.polygons[t];
    const auto& [a, b, c] = occluders.triangles[t];
    const Vec3& origin = occluders.vertices[a];
    normals[p] += (occluders.vertices[b] - origin).cross(occluders.vertices[c] - origin);
    for (int side = 0; side < 2; ++side) {
      int& known = of_polygon[p][side];
      const int cell = cells.cell[2 * t + side];
      known = known == none || known == cell ? cell : several;
    }
  }
  std::vector<int> result(mesh.size());
  for (int i = 0; i < mesh.size(); ++i) {
    const int p = mesh.polygons[i];
    result[i] = std::max(several, of_polygon[p][mesh.normals[i].dot(normals[p]) > 0 ? 0 : 1]);
  }
  return result;
}

}  // namespace luxel
