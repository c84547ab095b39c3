#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "luxel/input_error.h"
#include "luxel/mesh_scene.h"
#include "meshing/scenes.h"

namespace luxel {
namespace {

double longest_edge(const PatchMesh& mesh) {
  double longest = 0;
  for (int i = 0; i < mesh.size(); ++i) {
    for (int k = 0; k < mesh.corner_count(i); ++k) {
      const int next = mesh.corners[i][(k + 1) % mesh.corner_count(i)];
      longest = std::max(longest, (mesh.vertices[mesh.corners[i][k]] - mesh.vertices[next]).norm());
    }
  }
  return longest;
}

/// Whether every edge is run along once in each direction: a closed surface without T-vertices.
bool is_watertight(const PatchMesh& mesh) {
  std::map<std::pair<int, int>, int> net;
  for (int i = 0; i < mesh.size(); ++i) {
    for (int k = 0; k < mesh.corner_count(i); ++k) {
      const int a = mesh.corners[i][k];
      const int b = mesh.corners[i][(k + 1) % mesh.corner_count(i)];
      net[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  return std::all_of(net.begin(), net.end(), [](const auto& edge) { return edge.second == 0; });
}

/// A sphere of triangles: an icosahedron each of whose faces is cut into 4^level, corners on the unit sphere.
Scene sphere(int level) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  const std::vector<Vec3> v = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                               {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  const int faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                            {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                            {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                            {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  std::vector<std::array<Vec3, 3>> triangles;
  for (const auto& f : faces)
    triangles.push_back({v[f[0]].normalized(), v[f[1]].normalized(), v[f[2]].normalized()});
  for (; level > 0; --level) {
    std::vector<std::array<Vec3, 3>> finer;
    for (const auto& [a, b, c] : triangles) {
      const Vec3 ab = (a + b).normalized(), bc = (b + c).normalized(), ca = (c + a).normalized();
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    triangles = finer;
  }
  SceneMaker maker;
  for (const auto& [a, b, c] : triangles) maker.face({a, b, c});
  return maker.scene();
}

#ifdef LUXEL_WITH_CGAL
// What is promised of a lattice fill, see docs/meshing.md.
constexpr double smallest_angle = 24;  // [degrees]
constexpr double count_tolerance = 0.05;
#else
// Halving keeps at least half of the input's smallest angle, here that of a 1 by 0.5 rectangle: atan(0.5)
// / 2. The count moves in steps.
constexpr double smallest_angle = 13.28;
constexpr double count_tolerance = 0.5;
#endif

TEST(SizedMesh, GivesAboutThePatchesAskedFor) {
  const Scene scene = SceneMaker().room({0, 0, 0}, {1, 2, 3}).block({0.2, 0.3, 1}, {0.7, 1, 2}).scene();

  for (const int wanted : {1000, 5000, 40000}) {
    const PatchMesh mesh = mesh_scene(scene, {.patches = wanted});

    EXPECT_NEAR(mesh.size(), wanted, count_tolerance * wanted);
    EXPECT_GE(mesh.report.min_angle, smallest_angle);
    EXPECT_LE(mesh.report.area_error, 1e-6);
    EXPECT_EQ(mesh.report.remaining_t_vertices, 0);
    EXPECT_TRUE(is_watertight(mesh));
  }
}

TEST(SizedMesh, MakesAboutTheDefaultNumberOfPatches) {
  const Scene scene = SceneMaker().room({0, 0, 0}, {1, 1, 1}).scene();

  EXPECT_NEAR(mesh_scene(scene).size(), MeshingOptions::default_patches,
              count_tolerance * MeshingOptions::default_patches);
}

TEST(SizedMesh, MakesNoEdgeLongerThanThePatchSize) {
  const Scene scene = SceneMaker().room({0, 0, 0}, {1, 2, 3}).scene();

  for (const double size : {0.7, 0.2, 0.05}) {
    const PatchMesh mesh = mesh_scene(scene, {.patch_size = size});

    EXPECT_LE(longest_edge(mesh), size);
    EXPECT_GE(longest_edge(mesh), size / 2);
  }
}

TEST(SizedMesh, IsTheSameEveryTime) {
  const Scene scene = SceneMaker().room({0, 0, 0}, {1, 2, 3}).scene();

  EXPECT_EQ(geometry_hash(mesh_scene(scene, {.patches = 3000})),
            geometry_hash(mesh_scene(scene, {.patches = 3000})));
  EXPECT_NE(geometry_hash(mesh_scene(scene, {.patches = 3000})),
            geometry_hash(mesh_scene(scene, {.patches = 4000})));
}

TEST(SizedMesh, ClosesTJunctionsOfTheInput) {
  SceneMaker maker;  // a box whose floor is two quads under one wall each side
  maker.face({{0, 0, 0}, {0.4, 0, 0}, {0.4, 1, 0}, {0, 1, 0}});
  maker.face({{0.4, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.4, 1, 0}});
  maker.face({{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}});
  maker.face({{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}});
  maker.face({{0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}});
  maker.face({{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}});
  maker.face({{1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}});

  const PatchMesh mesh = mesh_scene(maker.scene(), {.patches = 500});

  EXPECT_EQ(mesh.report.repaired_t_junctions, 2);
  EXPECT_EQ(mesh.report.remaining_t_vertices, 0);
  EXPECT_TRUE(is_watertight(mesh));
}

#ifdef LUXEL_WITH_CGAL
TEST(SizedMesh, CutsTheFootprintOfABlockIntoTheFloor) {
  SceneMaker maker;
  maker.face({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  maker.block({1, 1, 0}, {2, 3, 1});

  const PatchMesh mesh = mesh_scene(maker.scene(), {.patches = 2000});

  EXPECT_EQ(mesh.report.imprinted_edges, 4);
  double covered = 0;
  for (int i = 0; i < mesh.size(); ++i) {
    if (mesh.faces[i] != 0) continue;
    int inside = 0;
    for (int k = 0; k < 3; ++k) {
      const Vec3& p = mesh.vertices[mesh.corners[i][k]];
      inside += p.x() > 1 + 1e-9 && p.x() < 2 - 1e-9 && p.y() > 1 + 1e-9 && p.y() < 3 - 1e-9;
    }
    const Vec3& c = mesh.centroids[i];
    const bool under = c.x() > 1 && c.x() < 2 && c.y() > 1 && c.y() < 3;
    EXPECT_TRUE(under || inside == 0);
    if (under) covered += mesh.areas[i];
  }
  EXPECT_NEAR(covered, 2, 1e-12);  // the patches under the block are just its footprint, 1 x 2
}
#endif

#ifdef LUXEL_WITH_CGAL
/// A unit cube, in it a sheet with a square pane of 0.02 and, 0.01 beside it, one of 0.01 x 0.6.
Scene cube_with_narrow_parts() {
  SceneMaker maker = SceneMaker().room({0, 0, 0}, {1, 1, 1});
  const int glass = maker.add_finish({.reflectance = Rgb::Constant(0.1)});
  maker.face({{0.5, 0.5, 0.3}, {0.52, 0.5, 0.3}, {0.52, 0.52, 0.3}, {0.5, 0.52, 0.3}}, glass);
  maker.face({{0.53, 0.2, 0.3}, {0.54, 0.2, 0.3}, {0.54, 0.8, 0.3}, {0.53, 0.8, 0.3}}, glass);
  const double x[] = {0.2, 0.5, 0.52, 0.53, 0.54, 0.8};
  const double y[] = {0.2, 0.5, 0.52, 0.8};
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (i == 3 || (i == 1 && j == 1)) continue;
      maker.face(
          {{x[i], y[j], 0.3}, {x[i + 1], y[j], 0.3}, {x[i + 1], y[j + 1], 0.3}, {x[i], y[j + 1], 0.3}});
    }
  }
  return maker.scene();
}

TEST(SizedMesh, GradesEdgesInNarrowParts) {
  const Scene scene = cube_with_narrow_parts();

  for (const int wanted : {1500, 5000, 20000}) {
    const PatchMesh mesh = mesh_scene(scene, {.patches = wanted});

    EXPECT_NEAR(mesh.size(), wanted, count_tolerance * wanted);
    EXPECT_GE(mesh.report.min_angle, smallest_angle);
    EXPECT_LE(mesh.report.area_error, 1e-12);
    EXPECT_EQ(mesh.report.remaining_t_vertices, 0);
    EXPECT_EQ(geometry_hash(mesh), geometry_hash(mesh_scene(scene, {.patches = wanted})));
  }
}

TEST(SizedMesh, GivesUpOnAnglesThatTakeTooManyPatches) {
  SceneMaker maker;  // two needles with corners of 0.006 degrees
  maker.face({{0, 0, 0}, {1, 0, 0}, {1, 1e-4, 0}}).face({{0, 0, 1}, {1, 0, 1}, {1, 1e-4, 1}});

  const PatchMesh mesh = mesh_scene(maker.scene(), {.patches = 1000});

  EXPECT_NEAR(mesh.size(), 1000, count_tolerance * 1000);
}
#endif

TEST(SizedMesh, KeepsBordersOfMaterials) {
  SceneMaker maker;
  const int other = maker.add_finish({.reflectance = Rgb::Constant(0.1)});
  maker.face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  maker.face({{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}}, other);

  const PatchMesh mesh = mesh_scene(maker.scene(), {.patches = 500});

  std::array<double, 2> areas = {0, 0};
  for (int i = 0; i < mesh.size(); ++i) {
    areas[mesh.finishes[i]] += mesh.areas[i];
    EXPECT_EQ(mesh.finishes[i], mesh.centroids[i].x() > 1 ? other : 0);
    EXPECT_EQ(mesh.faces[i], mesh.finishes[i]);
  }
  EXPECT_NEAR(areas[0], 1, 1e-12);
  EXPECT_NEAR(areas[1], 1, 1e-12);
  EXPECT_EQ(mesh.occluders.polygon_count, 1);
}

TEST(SizedMesh, TellsTheFaceThatEachPatchLiesIn) {
  SceneMaker maker;
  for (double y = 0; y < 4; ++y) {
    for (double x = 0; x < 4; ++x) maker.face({{x, y, 0}, {x + 1, y, 0}, {x + 1, y + 1, 0}, {x, y + 1, 0}});
  }

  const PatchMesh mesh = mesh_scene(maker.scene(), {.patches = 2000});

  for (int i = 0; i < mesh.size(); ++i) {
    // The centroid lies in the face's square, or on its border within rounding.
    const double x = mesh.faces[i] % 4;
    const double y = mesh.faces[i] / 4;
    const Vec3& c = mesh.centroids[i];
    EXPECT_TRUE(c.x() >= x - 1e-12 && c.x() <= x + 1 + 1e-12) << c.transpose();
    EXPECT_TRUE(c.y() >= y - 1e-12 && c.y() <= y + 1 + 1e-12) << c.transpose();
  }
}

TEST(SizedMesh, GivesBothSidesOfATwoSidedSheetTheSamePatches) {
  SceneMaker maker;
  const int sheet = maker.add_finish({.two_sided = true});
  maker.face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, sheet);

  const PatchMesh mesh = mesh_scene(maker.scene(), {.patches = 400});

  const int half = mesh.size() / 2;
  ASSERT_EQ(mesh.size(), 2 * half);
  for (int i = 0; i < half; ++i) {
    EXPECT_EQ(mesh.normals[i].z(), 1);
    EXPECT_EQ(mesh.normals[half + i].z(), -1);
    EXPECT_TRUE(mesh.centroids[i].isApprox(mesh.centroids[half + i]));
  }
}

TEST(SizedMesh, RefinesCurvedSurfacesWithoutGaps) {
  const Scene scene = sphere(2);  // 320 triangles

  for (const int wanted : {400, 1500, 20000}) {
    const PatchMesh mesh = mesh_scene(scene, {.patches = wanted});

    // Edges of like length are all halved at nearly the same size, so the count moves in steps.
    EXPECT_NEAR(mesh.size(), wanted, 0.35 * wanted);
    EXPECT_TRUE(is_watertight(mesh));
    EXPECT_LE(mesh.report.area_error, 1e-6);
  }
}

TEST(SizedMesh, JoinsCurvedAndFlatPartsWithoutGaps) {
  SceneMaker maker;  // a dome's rim on a disc: cone of many triangles over a polygon
  constexpr int sides = 40;
  const auto rim = [](int k) {
    return Vec3(std::cos(2 * M_PI * k / sides), std::sin(2 * M_PI * k / sides), 0);
  };
  std::vector<Vec3> disc;
  for (int k = 0; k < sides; ++k) {
    maker.face({rim(k), rim(k + 1), {0, 0, 0.5}});
    disc.insert(disc.begin(), rim(k));
  }
  maker.face(disc);

  for (const int wanted : {100, 1000, 5000})
    EXPECT_TRUE(is_watertight(mesh_scene(maker.scene(), {.patches = wanted})));
}

TEST(SizedMesh, FillsPolygonsWithHoles) {
  SceneMaker maker;  // a frame of four trapezoids
  const std::vector<Vec3> outer = {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}};
  const std::vector<Vec3> inner = {{1, 1, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}};
  for (int k = 0; k < 4; ++k) maker.face({outer[k], outer[(k + 1) % 4], inner[(k + 1) % 4], inner[k]});

  const PatchMesh mesh = mesh_scene(maker.scene(), {.patches = 1000});

  EXPECT_NEAR(total_area(mesh), 8, 1e-12);
  EXPECT_EQ(mesh.occluders.polygon_count, 1);
  EXPECT_EQ(mesh.occluders.triangles.size(), 8u);
  for (const Vec3& c : mesh.centroids) EXPECT_FALSE(c.x() > 1 && c.x() < 2 && c.y() > 1 && c.y() < 2);
}

TEST(SizedMesh, WorksAtAnyScaleAndOffset) {
  for (const double scale : {1e-6, 1e6}) {
    const Vec3 low = Vec3::Constant(1e6 * scale);
    const Scene scene = SceneMaker().room(low, low + scale * Vec3(1, 1, 1)).scene();

    const PatchMesh mesh = mesh_scene(scene, {.patches = 1000});

    EXPECT_NEAR(mesh.size(), 1000, count_tolerance * 1000);
    EXPECT_TRUE(is_watertight(mesh));
    EXPECT_LE(mesh.report.area_error, 1e-6);
  }
}

TEST(SizedMesh, KeepsThinWallsAndTinyBodies) {
  SceneMaker maker;
  maker.room({0, 0, 0}, {1, 1, 1})
      .room({1 + 1e-6, 0, 0}, {2, 1, 1})
      .block({0.5, 0.5, 0.5}, {0.500001, 0.500001, 0.500001});

  const PatchMesh mesh = mesh_scene(maker.scene(), {.patches = 2000});

  EXPECT_TRUE(is_watertight(mesh));
  EXPECT_EQ(mesh.occluders.polygon_count, 18);
  EXPECT_NEAR(total_area(mesh), 12 + 6e-12 - 4e-6, 1e-9);
}

TEST(SizedMesh, KeepsAnInputThatIsFinerThanAsked) {
  const PatchMesh mesh = mesh_scene(sphere(2), {.patches = 100});

  EXPECT_EQ(mesh.size(), 320);
  ASSERT_EQ(mesh.warnings.size(), 1u);
  EXPECT_NE(mesh.warnings[0].find("320"), std::string::npos);
}

TEST(SizedMesh, RefusesMorePatchesThanAllowed) {
  const Scene scene = SceneMaker().room({0, 0, 0}, {1, 1, 1}).scene();

  EXPECT_THROW(mesh_scene(scene, {.patch_size = 1e-6}), InputError);
  EXPECT_THROW(mesh_scene(scene, {.patches = 2000, .max_patches = 1000}), InputError);
}

TEST(SizedMesh, RefusesOptionsThatContradictEachOther) {
  const Scene scene = SceneMaker().room({0, 0, 0}, {1, 1, 1}).scene();

  EXPECT_THROW(mesh_scene(scene, {.as_is = true, .patches = 5}), std::invalid_argument);
  EXPECT_THROW(mesh_scene(scene, {.patch_size = -1}), std::invalid_argument);
  EXPECT_THROW(mesh_scene(scene, {.patch_size = std::nan("")}), std::invalid_argument);
  EXPECT_THROW(mesh_scene(scene, {.patches = -1}), std::invalid_argument);
  EXPECT_THROW(mesh_scene(scene, {.crease_angle = 0}), std::invalid_argument);
}

TEST(SizedMesh, StopsWhenProgressSaysSo) {
  const Scene scene = SceneMaker().room({0, 0, 0}, {1, 1, 1}).scene();

  EXPECT_THROW(mesh_scene(scene, {}, [](auto, double, double) { return false; }), Cancelled);
}

}  // namespace
}  // namespace luxel
