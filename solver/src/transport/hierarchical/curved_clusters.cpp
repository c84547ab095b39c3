#include "transport/hierarchical/curved_clusters.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace luxel {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// As for flat clusters.
constexpr double least_weight = 0.02;

// Normals that differ by more than this from their mean make a cluster that is never the end of a block: its
// patches do not look the same way.
constexpr double least_cone_cosine = 0.5;

// Axes along the two longest principal directions as seen along the mean normal.
ClusterAxes principal_axes(const PatchMesh& mesh, const WorkingFrame& frame, std::span<const int> patches,
                           const Vec3& normal, double total) {
  ClusterAxes axes;
  axes.middle.setZero();
  for (int p : patches) axes.middle += mesh.areas[p] / total * frame(mesh.centroids[p]);
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  for (int p : patches) {
    const Vec3 centroid = frame(mesh.centroids[p]) - axes.middle;
    // a twelfth of the sum over the corners: exact for triangles and parallelograms
    const int count = mesh.corner_count(p);
    Eigen::Matrix3d own = Eigen::Matrix3d::Zero();
    for (int k = 0; k < count; ++k) {
      const Vec3 x = frame(mesh.vertices[mesh.corners[p][k]]) - axes.middle - centroid;
      own += x * x.transpose();
    }
    moment += mesh.areas[p] / total * (centroid * centroid.transpose() + own / 12);
  }
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - normal * normal.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(across * moment * across);
  axes.u = eigen.eigenvectors().col(2);
  axes.u = (axes.u - axes.u.dot(normal) * normal).normalized();
  axes.v = normal.cross(axes.u);
  axes.spread_s = std::sqrt(std::max(axes.u.dot(moment * axes.u), 1e-300));
  axes.spread_t = std::sqrt(std::max(axes.v.dot(moment * axes.v), 1e-300));
  return axes;
}

}  // namespace

PatchCluster curved_cluster(const PatchHierarchy& hierarchy, int begin, int end, int first_group,
                            int last_group, CurvedCluster& curved) {
  const PatchMesh& mesh = *hierarchy.mesh;
  const WorkingFrame& frame = hierarchy.frame;
  PatchCluster cluster;
  cluster.begin = begin;
  cluster.end = end;
  const std::span<const FlatGroup> groups(hierarchy.groups.data() + first_group, last_group - first_group);
  Vec3 normal = Vec3::Zero();
  curved.low = Vec3::Constant(infinity);
  curved.high = -curved.low;
  for (const FlatGroup& group : groups) {
    cluster.area += group.area;
    normal += group.area * group.normal;
    curved.low = curved.low.cwiseMin(group.low);
    curved.high = curved.high.cwiseMax(group.high);
  }
  const double length = normal.norm();
  curved.normal = length > 1e-9 * cluster.area ? Vec3(normal / length) : Vec3::UnitZ();
  cluster.centre = 0.5 * (curved.low + curved.high);
  cluster.radius = 0.5 * (curved.high - curved.low).norm();
  curved.cone_cosine = 1;
  curved.setback = {infinity, -infinity};
  for (const FlatGroup& group : groups) {
    curved.cone_cosine = std::min(curved.cone_cosine, curved.normal.dot(group.normal));
    const double setback = group.normal.dot(cluster.centre) - group.offset;
    curved.setback.low = std::min(curved.setback.low, setback);
    curved.setback.high = std::max(curved.setback.high, setback);
  }
  curved.cone_sine = std::sqrt(std::max(0.0, 1 - curved.cone_cosine * curved.cone_cosine));
  cluster.usable = curved.cone_cosine >= least_cone_cosine;
  if (!cluster.usable) return cluster;

  const std::span<const int> patches(hierarchy.order.data() + begin, end - begin);
  const double total = cluster.area / (frame.scale * frame.scale);  // [m2]
  double radius = 0;
  for (int p : patches) {
    for (int k = 0; k < mesh.corner_count(p); ++k) {
      radius = std::max(radius, (frame(mesh.vertices[mesh.corners[p][k]]) - cluster.centre).norm());
    }
  }
  cluster.radius = radius;
  cluster.axes = principal_axes(mesh, frame, patches, curved.normal, total);
  cluster.weights.fill(0);
  curved.nodes.fill(Vec3::Zero());
  curved.normals.fill(Vec3::Zero());
  for (int p : patches) {
    const Vec3 x = frame(mesh.centroids[p]);
    const std::array<double, 4> f = cluster.axes.functions(x);
    for (int a = 0; a < 4; ++a) {
      cluster.weights[a] += mesh.areas[p] / total * f[a];
      curved.nodes[a] += mesh.areas[p] / total * f[a] * x;
      curved.normals[a] += mesh.areas[p] / total * f[a] * mesh.normals[p];
    }
  }
  const double least = *std::min_element(cluster.weights.begin(), cluster.weights.end());
  cluster.usable = least >= least_weight;
  if (!cluster.usable) return cluster;
  for (int a = 0; a < 4; ++a) {
    curved.nodes[a] /= cluster.weights[a];
    curved.normals[a] /= cluster.weights[a];
  }
  double squares = 0;
  for (int p : patches) {
    const Vec3 x = frame(mesh.centroids[p]);
    const std::array<double, 4> f = cluster.axes.functions(x);
    Vec3 off = -mesh.normals[p], aside = -x;
    for (int a = 0; a < 4; ++a) {
      off += f[a] * curved.normals[a];
      aside += f[a] * curved.nodes[a];
    }
    squares +=
        mesh.areas[p] / total * (off.squaredNorm() + aside.squaredNorm() / (cluster.radius * cluster.radius));
  }
  curved.roughness = std::sqrt(squares);
  return cluster;
}

}  // namespace luxel
