#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "luxel/form_factors.h"
#include "luxel/group_factors.h"
#include "luxel/ray_scene.h"
#include "patch_locator.h"
#include "point_factors/seen_pieces.h"
#include "sampling/owen_sobol.h"

namespace luxel {

namespace {

// Patches times occluder triangles up to which cutting takes a second or so.
constexpr double most_cuts = 1e8;

// Rays where there are more, in runs whose scatter gives the error.
constexpr int runs = 16;
constexpr int rays_a_run = 16384;
constexpr std::uint64_t point_stream = 0x706f696e74;

// point_form_factor takes polygons of 3 to 8 corners; larger pieces go as fans.
constexpr std::size_t most_corners = 8;

double piece_form_factor(const Vec3& point, const Vec3& normal, const ConvexPiece& piece) {
  double sum = 0;
  for (std::size_t first = 1; first + 1 < piece.size(); first += most_corners - 2) {
    ConvexPiece fan{piece[0]};
    const std::size_t end = std::min(first + most_corners - 1, piece.size());
    fan.insert(fan.end(), piece.begin() + first, piece.begin() + end);
    sum += point_form_factor(point, normal, fan);
  }
  return sum;
}

PointFactors cut_exactly(const PatchMesh& mesh, const Vec3& point, const Vec3& normal) {
  const PointView view(mesh.occluders, point, normal);
  std::vector<double> shares(mesh.size(), 0.0);
  tbb::parallel_for(tbb::blocked_range<int>(0, mesh.size(), 16), [&](const tbb::blocked_range<int>& range) {
    for (int i = range.begin(); i < range.end(); ++i) {
      if (mesh.normals[i].dot(point - mesh.centroids[i]) <= 0) continue;
      ConvexPiece outline;
      for (int k = 0; k < mesh.corner_count(i); ++k) outline.push_back(mesh.vertices[mesh.corners[i][k]]);
      for (const ConvexPiece& piece : view.seen_pieces(outline)) {
        shares[i] += piece_form_factor(point, normal, piece);
      }
    }
  });
  PointFactors result;
  result.form_factors.assign(mesh.group_names.size(), 0.0);
  for (int i = 0; i < mesh.size(); ++i) result.form_factors[mesh.groups[i]] += shares[i];
  result.open = 1;
  for (double share : result.form_factors) result.open -= share;
  result.open = std::clamp(result.open, 0.0, 1.0);
  return result;
}

PointFactors sample(const PatchMesh& mesh, const Vec3& point, const Vec3& normal) {
  const RayScene scene(mesh.occluders);
  const PatchLocator locator(mesh);
  const Vec3 tangent = normal.unitOrthogonal(), bitangent = normal.cross(tangent);
  const std::size_t groups = mesh.group_names.size();
  // one more column for what meets no front
  Eigen::MatrixXd counts = Eigen::MatrixXd::Zero(runs, static_cast<Eigen::Index>(groups) + 1);
  tbb::parallel_for(0, runs, [&](int run) {
    const OwenSobol4 sequence(mixed_seed(point_stream, run));
    const std::vector<Vec3> origins(rays_a_run, point), normals(rays_a_run, normal);
    std::vector<Vec3> directions;
    directions.reserve(rays_a_run);
    for (int k = 0; k < rays_a_run; ++k) {
      const auto [height, azimuth, unused_third, unused_fourth] = sequence(k);
      const double radius = std::sqrt(height), angle = 2 * std::numbers::pi * azimuth;
      directions.push_back(radius * std::cos(angle) * tangent + radius * std::sin(angle) * bitangent +
                           std::sqrt(1 - height) * normal);
    }
    std::vector<RayScene::Hit> hits(rays_a_run);
    scene.intersect(origins, normals, directions, hits);
    for (int k = 0; k < rays_a_run; ++k) {
      const RayScene::Hit& hit = hits[k];
      int patch = -1;
      if (hit.primitive >= 0) {
        patch = locator.patch_at(hit.primitive, hit.front, point + hit.distance * directions[k]);
      }
      counts(run, patch < 0 ? static_cast<Eigen::Index>(groups) : mesh.groups[patch]) += 1;
    }
  });
  counts /= rays_a_run;
  const Eigen::RowVectorXd mean = counts.colwise().mean();
  const Eigen::RowVectorXd variance = (counts.rowwise() - mean).colwise().squaredNorm() / (runs - 1.0) / runs;
  PointFactors result;
  result.form_factors.assign(mean.data(), mean.data() + groups);
  result.open = mean[static_cast<Eigen::Index>(groups)];
  result.error = std::sqrt(variance.maxCoeff());
  result.rays = static_cast<std::int64_t>(runs) * rays_a_run;
  return result;
}

}  // namespace

PointFactors point_to_groups(const PatchMesh& mesh, const Vec3& point, const Vec3& normal) {
  if (!point.allFinite()) throw std::invalid_argument("point_to_groups: the point is not finite");
  if (!(std::abs(normal.norm() - 1) <= 1e-6)) {
    throw std::invalid_argument("point_to_groups: the normal has not length 1");
  }
  const double cuts = static_cast<double>(mesh.size()) * static_cast<double>(mesh.occluders.triangles.size());
  return cuts <= most_cuts ? cut_exactly(mesh, point, normal) : sample(mesh, point, normal);
}

}  // namespace luxel
