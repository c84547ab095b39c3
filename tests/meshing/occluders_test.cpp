#include "occluders.h"

#include <gtest/gtest.h>

#include <map>

#include "luxel/mesh_scene.h"
#include "meshing/scenes.h"
#include "polygon.h"

namespace luxel {
namespace {

const MeshingOptions as_is = {.as_is = true};

double area(const Occluders& occluders) {
  double sum = 0;
  for (const auto& [a, b, c] : occluders.triangles) {
    const std::array<Vec3, 3> points = {occluders.vertices[a], occluders.vertices[b], occluders.vertices[c]};
    sum += area_vector(points).norm();
  }
  return sum;
}

TEST(Occluders, MergeCoplanarFacesWhateverTheirMaterial) {
  SceneMaker maker;
  const int other = maker.add_finish({.reflectance = Rgb::Constant(0.1)});
  for (double y = 0; y < 10; ++y) {
    for (double x = 0; x < 10; ++x) {
      maker.face({{x, y, 0}, {x + 1, y, 0}, {x + 1, y + 1, 0}, {x, y + 1, 0}},
                 static_cast<int>(x + y) % 2 ? other : 0);
    }
  }

  const PatchMesh mesh = mesh_scene(maker.scene(), as_is);

  EXPECT_EQ(mesh.occluders.polygon_count, 1);
  EXPECT_EQ(mesh.occluders.triangles.size(), 2u);
  EXPECT_EQ(mesh.occluders.vertices.size(), 4u);
  EXPECT_DOUBLE_EQ(area(mesh.occluders), 100);
}

TEST(Occluders, KeepAVertexThatAnyPolygonTurnsAt) {
  SceneMaker maker;  // two coplanar squares, and a triangle that hangs on half of their lower edge
  maker.face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  maker.face({{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}});
  maker.face({{0, 0, 0}, {0.5, 0, -1}, {1, 0, 0}});

  const Occluders occluders = mesh_scene(maker.scene(), as_is).occluders;

  // (1, 0, 0) is a corner of the triangle, so it divides the edge of the merged rectangle too: no gap can
  // arise.
  EXPECT_EQ(occluders.polygon_count, 2);
  std::map<std::pair<int, int>, int> uses;
  for (const auto& t : occluders.triangles) {
    for (int k = 0; k < 3; ++k) ++uses[std::minmax(t[k], t[(k + 1) % 3])];
  }
  const auto shared = [&](const Vec3& a, const Vec3& b) {
    int count = 0;
    for (const auto& [edge, n] : uses) {
      const Vec3& p = occluders.vertices[edge.first];
      const Vec3& q = occluders.vertices[edge.second];
      if ((p == a && q == b) || (p == b && q == a)) count = n;
    }
    return count;
  };
  EXPECT_EQ(shared({0, 0, 0}, {1, 0, 0}), 2);
}

TEST(Occluders, KeepTheAreaOfAPolygonWithAHole) {
  SceneMaker maker;
  const std::vector<Vec3> outer = {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}};
  const std::vector<Vec3> inner = {{1, 1, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}};
  for (int k = 0; k < 4; ++k) maker.face({outer[k], outer[(k + 1) % 4], inner[(k + 1) % 4], inner[k]});

  const Occluders occluders = mesh_scene(maker.scene(), as_is).occluders;

  EXPECT_EQ(occluders.polygon_count, 1);
  EXPECT_DOUBLE_EQ(area(occluders), 8);
}

TEST(Occluders, StandOnceForSheetsThatCoincide) {
  SceneMaker maker;  // the same wall from both rooms, cut along different diagonals
  maker.face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}).face({{0, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  maker.face({{0, 0, 0}, {0, 1, 0}, {1, 0, 0}}).face({{1, 0, 0}, {0, 1, 0}, {1, 1, 0}});

  const PatchMesh mesh = mesh_scene(maker.scene(), as_is);

  EXPECT_EQ(mesh.size(), 4);
  EXPECT_EQ(mesh.occluders.polygon_count, 1);
  EXPECT_DOUBLE_EQ(area(mesh.occluders), 1);
}

TEST(Occluders, DoNotFlattenCurvedSurfaces) {
  SceneMaker maker;  // a strip that turns by 1 degree from quad to quad
  constexpr int sides = 360;
  const auto rim = [](int k, double z) {
    const double angle = 2 * M_PI * k / sides;
    return Vec3(std::cos(angle), std::sin(angle), z);
  };
  for (int k = 0; k < sides; ++k) maker.face({rim(k, 0), rim(k + 1, 0), rim(k + 1, 1), rim(k, 1)});

  EXPECT_EQ(mesh_scene(maker.scene(), as_is).occluders.polygon_count, sides);
}

TEST(Occluders, AreTheSameForFineAndCoarsePatches) {
  const Scene scene = SceneMaker().room({0, 0, 0}, {1, 1, 1}).scene();

  const PatchMesh coarse = mesh_scene(scene, as_is);
  const PatchMesh fine = mesh_scene(scene, {.patches = 1000});

  EXPECT_EQ(coarse.occluders.triangles, fine.occluders.triangles);
  EXPECT_EQ(coarse.occluders.polygon_count, 6);
  for (int i = 0; i < fine.size(); ++i) EXPECT_EQ(fine.polygons[i], coarse.polygons[fine.faces[i]]);
}

}  // namespace
}  // namespace luxel
