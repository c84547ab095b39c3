#include "luxel/gouraud.h"

#include <gtest/gtest.h>

#include "luxel/mesh_scene.h"
#include "meshing/scenes.h"
#include "smooth_fans.h"
#include "vertex_corners.h"

namespace luxel {
namespace {

const MeshingOptions as_is = {.as_is = true};

/// A flat n x n grid of unit squares in the plane z = 0.
SceneMaker grid(int n, int finish = 0) {
  SceneMaker maker;
  for (double y = 0; y < n; ++y) {
    for (double x = 0; x < n; ++x) {
      maker.face({{x, y, 0}, {x + 1, y, 0}, {x + 1, y + 1, 0}, {x, y + 1, 0}}, finish);
    }
  }
  return maker;
}

PatchField field(const PatchMesh& mesh, auto value) {
  PatchField values(mesh.size(), 1);
  for (int i = 0; i < mesh.size(); ++i) values(i, 0) = value(mesh.centroids[i]);
  return values;
}

TEST(GouraudMesh, SharesVerticesWhereTheSurfaceIsSmooth) {
  const PatchMesh mesh = mesh_scene(grid(4).scene(), as_is);

  const GouraudMesh gouraud = gouraud_mesh(mesh);

  EXPECT_EQ(gouraud.vertices.size(), 25u);
  for (const Vec3& normal : gouraud.normals) EXPECT_TRUE(normal.isApprox(Vec3(0, 0, 1)));
}

TEST(GouraudMesh, SplitsVerticesAtCreases) {
  const PatchMesh mesh = mesh_scene(SceneMaker().room({0, 0, 0}, {1, 1, 1}).scene(), as_is);

  EXPECT_EQ(gouraud_mesh(mesh, 30).vertices.size(), 24u);
  EXPECT_EQ(gouraud_mesh(mesh, 91).vertices.size(), 8u);
}

TEST(GouraudMesh, SplitsVerticesAtMaterialBorders) {
  SceneMaker maker = grid(1);
  const int other = maker.add_finish({.reflectance = Rgb::Constant(0.1)});
  maker.face({{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}}, other);

  EXPECT_EQ(gouraud_mesh(mesh_scene(maker.scene(), as_is)).vertices.size(), 8u);
}

TEST(GouraudMesh, KeepsTheTwoSidesOfASheetApart) {
  SceneMaker sheet;
  const int finish = sheet.add_finish({.two_sided = true});
  sheet.face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, finish);
  sheet.face({{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}}, finish);

  const GouraudMesh gouraud = gouraud_mesh(mesh_scene(sheet.scene(), as_is));

  EXPECT_EQ(gouraud.vertices.size(), 12u);  // six on each side
}

TEST(GouraudMesh, HoldsASingleTwoSidedPatch) {
  SceneMaker sheet;  // front and back: each edge has two patches that run in opposite directions
  sheet.face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, sheet.add_finish({.two_sided = true}));
  const PatchMesh mesh = mesh_scene(sheet.scene(), as_is);

  testing::internal::CaptureStderr();
  const GouraudMesh gouraud = gouraud_mesh(mesh);

  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(gouraud.vertices.size(), 8u);
}

TEST(GouraudMesh, SplitsTheFloorWhereAWallStandsOnIt) {
  SceneMaker maker = grid(1);
  maker.face({{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}});
  maker.face({{1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}});

  EXPECT_EQ(gouraud_mesh(mesh_scene(maker.scene(), as_is)).vertices.size(), 12u);
}

TEST(GouraudMesh, TurnsNormalsWithACurvedSurface) {
  SceneMaker maker;
  constexpr int sides = 24;
  const auto rim = [](int k, double z) {
    const double angle = 2 * M_PI * k / sides;
    return Vec3(std::cos(angle), std::sin(angle), z);
  };
  for (int k = 0; k < sides; ++k) maker.face({rim(k, 0), rim(k + 1, 0), rim(k + 1, 1), rim(k, 1)});

  const GouraudMesh gouraud = gouraud_mesh(mesh_scene(maker.scene(), as_is));

  // On a regular prism the mean of two neighbouring normals is the radius through their common edge.
  EXPECT_EQ(gouraud.vertices.size(), 2u * sides);
  for (std::size_t v = 0; v < gouraud.vertices.size(); ++v) {
    const Vec3 radius(gouraud.vertices[v].x(), gouraud.vertices[v].y(), 0);
    EXPECT_TRUE(gouraud.normals[v].isApprox(radius, 1e-12));
  }
}

TEST(GouraudMesh, FindsTheSameFansOnHalfEdgesAndByIndex) {
  SceneMaker maker;  // a prism of 24 sides with one end, and a sheet of two materials
  constexpr int sides = 24;
  const auto rim = [](int k, double z) {
    return Vec3(std::cos(2 * M_PI * k / sides), std::sin(2 * M_PI * k / sides), z);
  };
  for (int k = 0; k < sides; ++k) {
    maker.face({rim(k, 0), rim(k + 1, 0), rim(k + 1, 1), rim(k, 1)});
    maker.face({rim(k, 1), rim(k + 1, 1), {0, 0, 1.2}});
  }
  const int other = maker.add_finish({.reflectance = Rgb::Constant(0.1)});
  for (double x = 3; x < 6; ++x) {
    maker.face({{x, 0, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}, {x, 1, 0}}, x < 5 ? 0 : other);
  }
  const PatchMesh mesh = mesh_scene(maker.scene(), as_is);
  Loops loops;
  for (const auto& row : mesh.corners) loops.append(std::span(row).first(count_corners(row)));
  const ManifoldParts parts =
      find_manifold_parts(loops, EdgeTable(loops, static_cast<int>(mesh.vertices.size())));
  std::vector<int> all(mesh.size());
  for (int i = 0; i < mesh.size(); ++i) all[i] = i;

  for (const double crease_angle : {10.0, 30.0, 120.0}) {
    const SmoothFans half_edges = find_fans_on_half_edges(mesh, all, parts, loops, crease_angle);
    const SmoothFans index = find_fans_by_index(mesh, all, crease_angle);

    ASSERT_EQ(half_edges.vertices.size(), index.vertices.size());
    std::vector<int> fan_by_index(index.vertices.size(), -1);
    for (int i = 0; i < mesh.size(); ++i) {
      for (int k = 0; k < mesh.corner_count(i); ++k) {
        const int a = half_edges.corners[i][k];
        const int b = index.corners[i][k];
        if (fan_by_index[a] < 0) fan_by_index[a] = b;
        EXPECT_EQ(fan_by_index[a], b);
        EXPECT_EQ(half_edges.vertices[a], index.vertices[b]);
        // OpenMesh takes angles from arc cosines: right to 1e-15 for the angles here
        EXPECT_TRUE(half_edges.normals[a].isApprox(index.normals[b], 1e-13));
      }
    }
  }
}

TEST(InterpolateToVertices, IsExactForConstants) {
  const PatchMesh mesh = mesh_scene(grid(5).scene(), as_is);
  const GouraudMesh gouraud = gouraud_mesh(mesh);

  const PatchField values = interpolate_to_vertices(mesh, gouraud, PatchField::Constant(mesh.size(), 3, 0.1));

  EXPECT_EQ(values.rows(), 36);
  EXPECT_TRUE((values.array() == 0.1).all());
}

TEST(InterpolateToVertices, ReproducesLinearFieldsInTheInterior) {
  const PatchMesh mesh = mesh_scene(grid(5).scene(), as_is);
  const GouraudMesh gouraud = gouraud_mesh(mesh);
  const auto linear = [](const Vec3& p) { return 3 + 2 * p.x() - p.y(); };

  const PatchField values = interpolate_to_vertices(mesh, gouraud, field(mesh, linear));

  for (std::size_t v = 0; v < gouraud.vertices.size(); ++v) {
    const Vec3& p = gouraud.vertices[v];
    const bool interior = p.x() > 0 && p.x() < 5 && p.y() > 0 && p.y() < 5;
    // At the border the value is held within that of the patches around, half a patch away: 0.5 (2 + 1).
    EXPECT_NEAR(values(v, 0), linear(p), interior ? 1e-12 : 1.5 + 1e-12);
  }
}

TEST(InterpolateToVertices, NeverLeavesTheRangeOfThePatches) {
  const PatchMesh mesh = mesh_scene(grid(6).scene(), as_is);
  const GouraudMesh gouraud = gouraud_mesh(mesh);
  const auto peak = [](const Vec3& p) { return std::exp(-8 * (p - Vec3(1, 1, 0)).squaredNorm()); };
  const PatchField patches = field(mesh, peak);

  const PatchField values = interpolate_to_vertices(mesh, gouraud, patches);

  EXPECT_GE(values.minCoeff(), patches.minCoeff());
  EXPECT_LE(values.maxCoeff(), patches.maxCoeff());
}

TEST(InterpolateToVertices, RefusesValuesOfAnotherMesh) {
  const PatchMesh mesh = mesh_scene(grid(2).scene(), as_is);

  EXPECT_THROW(interpolate_to_vertices(mesh, gouraud_mesh(mesh), PatchField::Zero(3, 1)),
               std::invalid_argument);
}

}  // namespace
}  // namespace luxel
