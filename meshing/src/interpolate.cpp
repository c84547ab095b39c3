#include <Eigen/Eigenvalues>
#include <algorithm>
#include <stdexcept>

#include "angle.h"
#include "luxel/gouraud.h"
#include "polygon.h"
#include "vertex_corners.h"

namespace luxel {

namespace {

// Directions in which the stencil is thinner than this share of its extent carry no slope: dividing by less
// would turn noise of the patches into large slopes.
constexpr double thinnest_stencil = 0.1;

/// Weights of patches, summing to 1 up to rounding; slopes may make some of them negative.
struct Stencil {
  std::vector<int> patches;
  std::vector<double> weights;
};

double corner_angle(const PatchMesh& mesh, Corner corner) {
  const auto& row = mesh.corners[corner.patch];
  const Vec3& p = mesh.vertices[row[corner.place]];
  const auto [before, after] = neighbours(row, corner.place);
  return angle_between(mesh.vertices[before] - p, mesh.vertices[after] - p);
}

/// Whether the fan goes all the way round: every edge that one patch runs out along, another comes in along.
bool is_interior(const PatchMesh& mesh, std::span<const Corner> fan) {
  std::vector<int> outwards, inwards;
  for (const Corner& corner : fan) {
    const auto [before, after] = neighbours(mesh.corners[corner.patch], corner.place);
    outwards.push_back(after);
    inwards.push_back(before);
  }
  std::sort(outwards.begin(), outwards.end());
  std::sort(inwards.begin(), inwards.end());
  return outwards == inwards;
}

Stencil average(const PatchMesh& mesh, std::span<const Corner> fan) {
  Stencil stencil;
  double total = 0;
  for (const Corner& corner : fan) {
    stencil.patches.push_back(corner.patch);
    stencil.weights.push_back(corner_angle(mesh, corner));
    total += stencil.weights.back();
  }
  for (double& weight : stencil.weights) weight /= total;
  return stencil;
}

/// The fan's patches and all that share one of their Gouraud vertices.
std::vector<int> patches_around(const GouraudMesh& gouraud, const VertexCorners& corners_of,
                                std::span<const Corner> fan) {
  std::vector<int> patches;
  for (const Corner& corner : fan) {
    const auto& row = gouraud.corners[corner.patch];
    for (int k = 0; k < count_corners(row); ++k) {
      for (const Corner& neighbour : corners_of[row[k]]) patches.push_back(neighbour.patch);
    }
  }
  std::sort(patches.begin(), patches.end());
  patches.erase(std::unique(patches.begin(), patches.end()), patches.end());
  return patches;
}

/// Least-squares plane through the values at the centroids, taken at the vertex.
Stencil extrapolation(const PatchMesh& mesh, std::vector<int> patches, const Vec3& vertex,
                      const Vec3& normal) {
  const auto axes = plane_axes(normal);
  std::vector<Vec2> places;
  Vec2 mean = Vec2::Zero();
  for (const int patch : patches) {
    const Vec3 d = mesh.centroids[patch] - vertex;
    places.emplace_back(d.dot(axes[0]), d.dot(axes[1]));
    mean += places.back();
  }
  mean /= static_cast<double>(places.size());
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const Vec2& place : places) spread += (place - mean) * (place - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> principal(spread);
  Vec2 slope_weight = Vec2::Zero();
  for (int k = 0; k < 2; ++k) {
    const double extent = principal.eigenvalues()[k];
    if (extent <= thinnest_stencil * thinnest_stencil * principal.eigenvalues()[1] || extent <= 0) continue;
    const Vec2 axis = principal.eigenvectors().col(k);
    slope_weight += axis * (axis.dot(-mean) / extent);
  }
  Stencil stencil{std::move(patches), {}};
  for (const Vec2& place : places) {
    stencil.weights.push_back(1.0 / static_cast<double>(places.size()) + slope_weight.dot(place - mean));
  }
  return stencil;
}

}  // namespace

PatchField interpolate_to_vertices(const PatchMesh& mesh, const GouraudMesh& gouraud,
                                   const PatchField& patch_values) {
  if (patch_values.rows() != mesh.size() || gouraud.corners.size() != mesh.corners.size()) {
    throw std::invalid_argument("interpolate_to_vertices: expected one row of values per patch of the mesh");
  }
  const int vertex_count = static_cast<int>(gouraud.vertices.size());
  const VertexCorners corners_of(gouraud.corners, vertex_count);
  PatchField values(vertex_count, patch_values.cols());
  for (int v = 0; v < vertex_count; ++v) {
    const std::span<const Corner> fan = corners_of[v];
    const Stencil stencil = is_interior(mesh, fan)
                                ? average(mesh, fan)
                                : extrapolation(mesh, patches_around(gouraud, corners_of, fan),
                                                gouraud.vertices[v], gouraud.normals[v]);
    Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(values.cols());
    Eigen::RowVectorXd low = patch_values.row(stencil.patches.front());
    Eigen::RowVectorXd high = low;
    for (std::size_t k = 0; k < stencil.patches.size(); ++k) {
      const auto row = patch_values.row(stencil.patches[k]);
      sum += stencil.weights[k] * row;
      low = low.cwiseMin(row);
      high = high.cwiseMax(row);
    }
    values.row(v) = sum.cwiseMax(low).cwiseMin(high);
  }
  return values;
}

}  // namespace luxel
