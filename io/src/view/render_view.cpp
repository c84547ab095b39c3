#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "luxel/input_error.h"
#include "luxel/ray_scene.h"
#include "luxel/view.h"
#include "view_rays.h"

namespace luxel {

namespace {

constexpr int most_samples = 4096;

// Rows between two reports of progress: some 40 of them a picture
constexpr int rows_per_band = 16;

// A back that is nearer than a front by less than this share of the distance is the other side of its sheet
constexpr double sheet_thickness = 1e-5;

struct Sight {
  int patch = Image::nothing;
  double distance = std::numeric_limits<double>::infinity();
  std::array<double, 3> weights{};  // of the three corners
  std::array<int, 3> corners{};     // of the patch
};

/// The patches that turn one side to the eye, as a ray scene: which side that is, is the same for all rays.
class Sheets {
 public:
  Sheets(const PatchMesh& mesh, const Vec3& eye, bool fronts)
      : patches_(facing(mesh, eye, fronts)), rays_(part(mesh, patches_)) {}

  void look(std::span<const Vec3> origins, std::span<const Vec3> directions, std::vector<RayScene::Hit>& hits,
            std::vector<Sight>& sights) const {
    hits.resize(origins.size());
    sights.assign(origins.size(), Sight());
    if (patches_.empty()) return;
    // the eye lies on no surface: a hair along the ray does no harm
    rays_.intersect(origins, directions, directions, hits);
    for (std::size_t k = 0; k < hits.size(); ++k) {
      if (hits[k].primitive < 0) continue;
      const bool second = (hits[k].primitive & RayScene::second_half) != 0;
      const double u = std::clamp(static_cast<double>(hits[k].u), 0.0, 1.0);
      const double v = std::clamp(static_cast<double>(hits[k].v), 0.0, 1 - u);
      sights[k] = {patches_[hits[k].primitive & ~RayScene::second_half],
                   hits[k].distance,
                   {1 - u - v, u, v},
                   {0, second ? 2 : 1, second ? 3 : 2}};
    }
  }

 private:
  static std::vector<int> facing(const PatchMesh& mesh, const Vec3& eye, bool fronts) {
    std::vector<int> patches;
    for (int i = 0; i < mesh.size(); ++i) {
      if ((mesh.normals[i].dot(eye - mesh.centroids[i]) > 0) == fronts) patches.push_back(i);
    }
    return patches;
  }

  static PatchMesh part(const PatchMesh& mesh, const std::vector<int>& patches) {
    PatchMesh result;
    result.vertices = mesh.vertices;
    for (const int i : patches) result.corners.push_back(mesh.corners[i]);
    return result;
  }

  std::vector<int> patches_;
  RayScene rays_;
};

class Renderer {
 public:
  Renderer(const PatchMesh& mesh, const GouraudMesh& gouraud, const PatchField& vertex_radiosity,
           const Camera& camera, const ViewOptions& options)
      : gouraud_(gouraud),
        radiosity_(vertex_radiosity),
        camera_(camera),
        rays_(camera),
        samples_(tent_samples(options.samples)),
        fronts_(mesh, camera.eye, true) {
    if (options.backs == Backs::black) backs_.emplace(mesh, camera.eye, false);
  }

  /// Fills one row of the image. Rows are independent, and each sums its samples in a fixed order.
  void row(int y, Image& image) const {
    const int width = camera_.width;
    Row work(width, camera_.eye);
    std::vector<Rgb> sum(width, Rgb::Zero());
    for (const Eigen::Vector2d& sample : samples_) {
      look(y + 0.5 + sample[1], 0.5 + sample[0], work);
      for (int x = 0; x < width; ++x) sum[x] += radiance(work.sights[x]);
    }
    look(y + 0.5, 0.5, work);
    for (int x = 0; x < width; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * width + x;
      for (int k = 0; k < 3; ++k) {
        image.rgb[3 * pixel + k] = static_cast<float>(sum[x][k] / static_cast<double>(samples_.size()));
      }
      const double depth = work.sights[x].distance * work.directions[x].dot(rays_.forward());
      image.depth[pixel] = static_cast<float>(depth);
      image.patch[pixel] = work.sights[x].patch;
    }
  }

 private:
  struct Row {
    Row(int width, const Vec3& eye) : origins(width, eye), directions(width) {}
    std::vector<Vec3> origins, directions;
    std::vector<RayScene::Hit> hits;
    std::vector<Sight> sights, backs;
  };

  // What is seen at height y and at x, x + 1, x + 2, ... across the picture
  void look(double y, double x, Row& row) const {
    for (int i = 0; i < camera_.width; ++i) row.directions[i] = rays_.direction(x + i, y);
    fronts_.look(row.origins, row.directions, row.hits, row.sights);
    if (!backs_) return;
    backs_->look(row.origins, row.directions, row.hits, row.backs);
    for (int i = 0; i < camera_.width; ++i) {
      if (row.backs[i].distance < (1 - sheet_thickness) * row.sights[i].distance) {
        row.sights[i] = row.backs[i];
        row.sights[i].weights = {};
      }
    }
  }

  Rgb radiance(const Sight& sight) const {
    Rgb radiosity = Rgb::Zero();
    if (sight.patch == Image::nothing) return radiosity;
    for (int k = 0; k < 3; ++k) {
      if (sight.weights[k] == 0) continue;
      const int vertex = gouraud_.corners[sight.patch][sight.corners[k]];
      radiosity += sight.weights[k] * radiosity_.row(vertex).transpose().array();
    }
    return radiosity / std::numbers::pi;
  }

  const GouraudMesh& gouraud_;
  const PatchField& radiosity_;
  const Camera& camera_;
  ViewRays rays_;
  std::vector<Eigen::Vector2d> samples_;
  Sheets fronts_;
  std::optional<Sheets> backs_;
};

}  // namespace

Image render_view(const PatchMesh& mesh, const GouraudMesh& gouraud, const PatchField& vertex_radiosity,
                  const Camera& camera, const ViewOptions& options, const Progress& progress) {
  if (gouraud.corners.size() != mesh.corners.size() || vertex_radiosity.cols() != 3 ||
      static_cast<std::size_t>(vertex_radiosity.rows()) != gouraud.vertices.size()) {
    throw std::invalid_argument("render_view: mesh, Gouraud mesh and radiosity do not fit each other");
  }
  if (options.samples < 1 || options.samples > most_samples) {
    throw std::invalid_argument("render_view: samples not in [1, 4096]");
  }
  const Renderer renderer(mesh, gouraud, vertex_radiosity, camera, options);
  Image image;
  image.width = camera.width;
  image.height = camera.height;
  const std::size_t pixels = static_cast<std::size_t>(camera.width) * camera.height;
  image.rgb.resize(3 * pixels);
  image.depth.resize(pixels);
  image.patch.resize(pixels);
  for (int first = 0; first < camera.height; first += rows_per_band) {
    const int last = std::min(camera.height, first + rows_per_band);
    tbb::parallel_for(first, last, [&](int y) { renderer.row(y, image); });
    if (progress && !progress("view", last, camera.height)) throw Cancelled();
  }
  return image;
}

}  // namespace luxel
