#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "io/small_mesh.h"
#include "luxel/input_error.h"
#include "luxel/view.h"
#include "view/view_rays.h"

namespace luxel {
namespace {

using std::numbers::pi;

Camera camera(const Vec3& eye, const Vec3& target, int width = 40, int height = 30) {
  Camera result;
  result.eye = eye;
  result.target = target;
  result.width = width;
  result.height = height;
  return result;
}

/// A view of a mesh whose Gouraud vertices are its own, with `radiosity` a function of the vertex.
template <class Function>
Image view(const PatchMesh& mesh, const Camera& camera, Function radiosity, const ViewOptions& options = {}) {
  PatchField values(mesh.vertices.size(), 3);
  for (int v = 0; v < values.rows(); ++v) {
    const Rgb value = radiosity(mesh.vertices[v]);
    for (int k = 0; k < 3; ++k) values(v, k) = value[k];
  }
  return render_view(mesh, testing::own_vertices(mesh), values, camera, options);
}

Rgb one(const Vec3&) {
  return Rgb::Ones();
}

TEST(RenderView, AClosedRoomOfOneRadiosityIsAnImageOfOneRadiance) {
  const PatchMesh room = testing::inward_cube(3);

  const Image image = view(room, camera({0.3, 0.1, 0.2}, {-1, 0.4, 0.9}), one);

  // L = B / pi; the weights of a point sum to 1 within a few roundings of float64
  for (const float value : image.rgb) EXPECT_FLOAT_EQ(value, 1 / pi);
  for (const int patch : image.patch) EXPECT_GE(patch, 0);
}

TEST(RenderView, GouraudValuesOfALinearFieldAreThatField) {
  const PatchMesh mesh = testing::half_quad_half_triangles();
  const Camera above = camera({0.5, 0.5, 2}, {0.5, 0.5, 0}, 64, 64);
  const ViewRays rays(above);

  const Image image = view(mesh, above, [](const Vec3& x) { return Rgb(x[0], x[1], x[0] + 2 * x[1]); });

  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const Vec3 direction = rays.direction(x + 0.5, y + 0.5);
      const Vec3 met = above.eye + direction * (above.eye[2] / -direction[2]);
      // pixels whose samples all meet the square: a pixel is 0.023 wide there
      if (met[0] < 0.03 || met[0] > 0.97 || met[1] < 0.03 || met[1] > 0.97) continue;
      const Rgb radiosity = image.pixel(x, y) * pi;
      // the mean of the samples' offsets, 1/32 pixel times the field's slope, and barycentric weights in
      // float
      EXPECT_NEAR(radiosity[0], met[0], 0.002);
      EXPECT_NEAR(radiosity[1], met[1], 0.002);
      EXPECT_NEAR(radiosity[2], met[0] + 2 * met[1], 0.004);
    }
  }
}

TEST(RenderView, ThePictureIsUprightAndNotMirrored) {
  const PatchMesh room = testing::inward_cube(1);

  const Image image = view(room, camera({0, 0, 0}, {0, 0, -1}), one);

  // looking along -z with y up and x to the right; groups of inward_cube: -x, +x, -y, +y, -z, +z
  const auto group = [&](int x, int y) { return room.groups[image.patch[y * image.width + x]]; };
  EXPECT_EQ(group(20, 15), 4);
  const Image wide = [&] {
    Camera fish = camera({0, 0, 0}, {0, 0, -1});
    fish.fov = 120;
    return view(room, fish, one);
  }();
  const auto wide_group = [&](int x, int y) { return room.groups[wide.patch[y * wide.width + x]]; };
  EXPECT_EQ(wide_group(0, 15), 0);
  EXPECT_EQ(wide_group(39, 15), 1);
  EXPECT_EQ(wide_group(20, 29), 2);
  EXPECT_EQ(wide_group(20, 0), 3);
}

TEST(RenderView, DepthIsTheDistanceFromTheEyesPlane) {
  const PatchMesh room = testing::inward_cube(2);

  const Image image = view(room, camera({0, 0, 0.5}, {0, 0, -1}), one);

  // the far wall at z = -1 fills the middle; float32
  for (int y = 12; y < 18; ++y) {
    for (int x = 17; x < 23; ++x) EXPECT_FLOAT_EQ(image.depth[y * 40 + x], 1.5f);
  }
}

TEST(RenderView, FromOutsideOneSeesIntoAClosedRoom) {
  const PatchMesh room = testing::inward_cube(2);

  const Image image = view(room, camera({0, 0, 6}, {0, 0, 0}), one);

  const int centre = 15 * 40 + 20;
  EXPECT_EQ(room.groups[image.patch[centre]], 4);  // the far wall, through the near one
  EXPECT_FLOAT_EQ(image.depth[centre], 7);
  EXPECT_EQ(image.patch[0], Image::nothing);
  EXPECT_EQ(image.rgb[0], 0);
  EXPECT_TRUE(std::isinf(image.depth[0]));
}

TEST(RenderView, BlackBacksHideWhatIsBehindThem) {
  const PatchMesh room = testing::inward_cube(2);

  const Image image = view(room, camera({0, 0, 6}, {0, 0, 0}), one, {.backs = Backs::black});

  const int centre = 15 * 40 + 20;
  EXPECT_EQ(room.groups[image.patch[centre]], 5);
  EXPECT_FLOAT_EQ(image.depth[centre], 5);
  EXPECT_EQ(image.rgb[3 * centre], 0);
}

TEST(RenderView, OfATwoSidedSheetTheSideThatFacesTheEyeIsSeen) {
  for (const Backs backs : {Backs::culled, Backs::black}) {
    for (const double side : {-1.0, 1.0}) {
      PatchMesh sheet = testing::half_quad_half_triangles();
      for (int i = 0; i < 3; ++i) {
        auto corners = sheet.corners[i];
        std::reverse(corners.begin(), corners.begin() + sheet.corner_count(i));
        testing::append_patch(sheet, corners);
      }

      const Image image =
          view(sheet, camera({0.4, 0.45, side}, {0.5, 0.5, 0}, 21, 21), one, {.backs = backs});

      for (int y = 5; y < 16; ++y) {
        for (int x = 5; x < 16; ++x) {
          EXPECT_EQ(image.patch[y * 21 + x]<3, side> 0);
          EXPECT_FLOAT_EQ(image.rgb[3 * (y * 21 + x)], 1 / pi);
        }
      }
    }
  }
}

TEST(RenderView, HasTheSameBitsForAnyNumberOfThreads) {
  const PatchMesh room = testing::inward_cube(4);
  const Camera inside = camera({0.3, 0.1, 0.2}, {-1, 0.4, 0.9}, 64, 48);
  const auto radiosity = [](const Vec3& x) { return Rgb((3 * x.array()).sin() + 1); };
  const auto with_threads = [&](int threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return view(room, inside, radiosity);
  };

  const Image one_thread = with_threads(1), two_threads = with_threads(2);

  EXPECT_EQ(one_thread.rgb, two_threads.rgb);
  EXPECT_EQ(one_thread.depth, two_threads.depth);
  EXPECT_EQ(one_thread.patch, two_threads.patch);
}

TEST(RenderView, SceneFarFromTheOriginLooksTheSame) {
  PatchMesh room = testing::inward_cube(2);
  const Vec3 shift(1e6, -2e6, 5e5);
  const Camera here = camera({0, 0, 6}, {0, 0, 0}, 33, 33);
  const Image expected = view(room, here, one);

  for (Vec3& x : room.vertices) x += shift;
  for (Vec3& x : room.centroids) x += shift;
  const Image image = view(room, camera(here.eye + shift, here.target + shift, 33, 33), one);

  EXPECT_EQ(image.patch, expected.patch);
}

TEST(RenderView, CanBeCancelled) {
  const PatchMesh room = testing::inward_cube(1);
  const PatchField radiosity = PatchField::Ones(24, 3);

  EXPECT_THROW(render_view(room, testing::own_vertices(room), radiosity, Camera(), {},
                           [](std::string_view, double, double) { return false; }),
               Cancelled);
}

TEST(RenderView, OfNoPatchesIsBlack) {
  const Image image = render_view(PatchMesh(), GouraudMesh(), PatchField(0, 3), camera({0, 0, 1}, {0, 0, 0}));

  EXPECT_EQ(image.rgb, std::vector<float>(3 * 40 * 30, 0.0f));
}

TEST(RenderView, RefusesCamerasThatGiveNoPicture) {
  const PatchMesh room = testing::inward_cube(1);
  const auto refused = [&](Camera bad) { EXPECT_THROW(view(room, bad, one), std::invalid_argument); };
  Camera bad = camera({0, 0, 0}, {0, 0, 0});
  refused(bad);
  bad = camera({0, 0, 0}, {0, 1, 0});  // along up
  refused(bad);
  bad = camera({0, 0, 0}, {0, 0, 1});
  bad.fov = 180;
  refused(bad);
  bad.fov = 40;
  bad.width = 0;
  refused(bad);
}

TEST(TentSamples, AverageToTheCentreWithTheTentsVariance) {
  const auto samples = tent_samples(1024);

  Eigen::Vector2d mean = Eigen::Vector2d::Zero(), square = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& x : samples) {
    EXPECT_LT(x.cwiseAbs().maxCoeff(), 1);
    mean += x / 1024;
    square += x.cwiseAbs2() / 1024;
  }
  // the variance of 1 - |x| on [-1, 1] is 1/6; a Hammersley set of n points integrates to about log(n) / n
  EXPECT_LT(mean.norm(), 0.01);
  EXPECT_NEAR(square[0], 1.0 / 6, 0.01);
  EXPECT_NEAR(square[1], 1.0 / 6, 0.01);
}

TEST(ViewCamera, IsTheMeshsOwnWhereThereIsOne) {
  PatchMesh mesh = testing::inward_cube(1);
  mesh.camera = camera({1, 2, 3}, {4, 5, 6});

  EXPECT_EQ(view_camera(mesh).eye, Vec3(1, 2, 3));
}

TEST(ViewCamera, LooksIntoABoxThroughItsOpenSide) {
  PatchMesh mesh;
  mesh.finish_table = {Finish()};
  const PatchMesh cube = testing::inward_cube(1);
  mesh.vertices = cube.vertices;
  for (int i = 0; i < cube.size(); ++i) {
    if (cube.groups[i] != 1) testing::append_patch(mesh, cube.corners[i]);  // without +x
  }

  const Camera found = view_camera(mesh);

  EXPECT_GT(found.eye[0], 1);
  EXPECT_NEAR(found.eye[1], 0, 1e-12);
  EXPECT_NEAR(found.eye[2], 0, 1e-12);
}

TEST(ViewCamera, ShowsAllOfAClosedRoom) {
  const PatchMesh room = testing::inward_cube(1);
  Camera found = view_camera(room, 60, 60);

  const Image image = view(room, found, one);

  for (int i = 0; i < 60; ++i) {  // a black frame all around
    EXPECT_EQ(image.patch[i], Image::nothing);
    EXPECT_EQ(image.patch[59 * 60 + i], Image::nothing);
    EXPECT_EQ(image.patch[60 * i], Image::nothing);
    EXPECT_EQ(image.patch[60 * i + 59], Image::nothing);
  }
  EXPECT_GE(image.patch[3 * 60 + 30], 0);  // and not a wide one
}

}  // namespace
}  // namespace luxel
