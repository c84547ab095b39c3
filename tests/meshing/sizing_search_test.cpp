#include "sizing_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "luxel/mesh_scene.h"
#include "meshing/scenes.h"

namespace luxel {
namespace {

#ifdef LUXEL_WITH_CGAL

/// Whether every edge is run along once in each direction: a closed surface without T-vertices.
bool is_watertight(const PatchMesh& mesh) {
  std::map<std::pair<int, int>, int> net;
  for (const auto& [a, b, c, none] : mesh.corners) {
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      net[std::minmax(from, to)] += from < to ? 1 : -1;
    }
  }
  return std::all_of(net.begin(), net.end(), [](const auto& edge) { return edge.second == 0; });
}

/// A box of unit squares, in two materials in turn so that none are merged; normals point inwards.
Scene squares(int nx, int ny, int nz) {
  SceneMaker maker;
  const int other = maker.add_finish({.reflectance = Rgb::Constant(0.1)});
  const std::array<int, 3> n = {nx, ny, nz};
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (const int end : {0, n[axis]}) {
      for (int i = 0; i < n[u]; ++i) {
        for (int j = 0; j < n[v]; ++j) {
          const auto corner = [&](int di, int dj) {
            Vec3 p;
            p[axis] = end;
            p[u] = i + di;
            p[v] = j + dj;
            return p;
          };
          std::vector<Vec3> face = {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
          if (end > 0) std::swap(face[1], face[3]);
          maker.face(face, (i + j + (end > 0 ? 1 : 0)) % 2 ? other : 0);
        }
      }
    }
  }
  return maker.scene();
}

/// Two spheres of 20 * 4^level triangles each, the smaller one inside.
Scene two_spheres(int level) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  const std::vector<Vec3> v = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                               {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  const int faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                            {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                            {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                            {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  std::vector<std::array<Vec3, 3>> triangles;
  for (const auto& f : faces) {
    triangles.push_back({v[f[0]].normalized(), v[f[1]].normalized(), v[f[2]].normalized()});
  }
  for (; level > 0; --level) {
    std::vector<std::array<Vec3, 3>> finer;
    for (const auto& [a, b, c] : triangles) {
      const Vec3 ab = (a + b).normalized(), bc = (b + c).normalized(), ca = (c + a).normalized();
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    triangles = finer;
  }
  SceneMaker maker;
  for (const auto& [a, b, c] : triangles) maker.face({a, b, c}).face({2 * c, 2 * b, 2 * a});
  return maker.scene();
}

// What the search comes within on these scenes; what is promised is 5 %.
constexpr double near = 0.021;

TEST(SizingSearch, ComesNearTheNumberAskedForWhereAllPartsAreAlike) {
  const Scene scenes[] = {squares(10, 1, 1), squares(1, 1, 1), squares(4, 4, 4)};  // 42, 6, 96 squares

  for (const Scene& scene : scenes) {
    for (const int wanted : {300, 700, 1000, 3000, 10000}) {
      if (wanted < 4 * scene.face_count()) continue;  // a square is two triangles at least
      const PatchMesh mesh = mesh_scene(scene, {.patches = wanted});

      EXPECT_NEAR(mesh.size(), wanted, near * wanted) << scene.face_count() << " squares";
      EXPECT_GE(mesh.report.min_angle, 24);  // what is promised of a lattice fill
      EXPECT_EQ(mesh.report.remaining_t_vertices, 0);
      EXPECT_TRUE(is_watertight(mesh));
      EXPECT_LE(mesh.report.area_error, 1e-12);
    }
  }
}

TEST(SizingSearch, StopsHalfwayThroughEdgesOfOneLengthOnCurvedSurfaces) {
  const Scene scene = two_spheres(2);  // 640 triangles

  for (const int wanted : {700, 1000, 1300, 3000, 10000}) {
    const PatchMesh mesh = mesh_scene(scene, {.patches = wanted});

    EXPECT_NEAR(mesh.size(), wanted, near * wanted);
    EXPECT_TRUE(is_watertight(mesh));
    EXPECT_GE(mesh.report.min_angle, 24);  // half of the input's sharpest, 54.4 degrees, at the least
  }
}

TEST(SizingSearch, MixesFlatAndCurvedParts) {
  SceneMaker maker;  // a cone of 40 triangles over a disc, in a box
  constexpr int sides = 40;
  const auto rim = [](int k) {
    return Vec3(std::cos(2 * M_PI * k / sides), std::sin(2 * M_PI * k / sides), 0);
  };
  std::vector<Vec3> disc;
  for (int k = 0; k < sides; ++k) {
    maker.face({rim(k), rim(k + 1), {0, 0, 0.5}});
    disc.insert(disc.begin(), rim(k));
  }
  maker.face(disc).room({-2, -2, -1}, {2, 2, 1});

  for (const int wanted : {300, 1000, 3000}) {
    const PatchMesh mesh = mesh_scene(maker.scene(), {.patches = wanted});

    EXPECT_NEAR(mesh.size(), wanted, 0.05 * wanted);
    EXPECT_TRUE(is_watertight(mesh));
  }
}

TEST(SizingSearch, GivesTheSamePatchesEveryTime) {
  const Scene scene = squares(10, 1, 1);

  EXPECT_EQ(geometry_hash(mesh_scene(scene, {.patches = 1000})),
            geometry_hash(mesh_scene(scene, {.patches = 1000})));
}

#endif

}  // namespace
}  // namespace luxel
