#include "mesh_quality.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "angle.h"
#include "polygon.h"

namespace luxel {

namespace {

// Share of the patches that may be sharper than one_percent_angle.
constexpr double percentile = 0.01;

double smallest_angle(std::span<const Vec3> loop) {
  const std::size_t n = loop.size();
  double smallest = 180;
  for (std::size_t i = 0; i < n; ++i) {
    smallest = std::min(smallest, degrees_per_radian * angle_between(loop[(i + 1) % n] - loop[i],
                                                                     loop[(i + n - 1) % n] - loop[i]));
  }
  return smallest;
}

}  // namespace

void measure_quality(PatchMesh& mesh, const Facets& facets, double cut_area) {
  std::vector<double> angles;
  angles.reserve(mesh.size());
  double area = 0;
  double aspect = 0;
  std::array<Vec3, 4> corners;
  for (int i = 0; i < mesh.size(); ++i) {
    const int count = mesh.corner_count(i);
    double perimeter = 0;
    for (int k = 0; k < count; ++k) corners[k] = mesh.vertices[mesh.corners[i][k]];
    for (int k = 0; k < count; ++k) perimeter += (corners[(k + 1) % count] - corners[k]).norm();
    const auto loop = std::span<const Vec3>(corners).first(count);
    angles.push_back(smallest_angle(loop));
    // In-radius of a polygon that has an inscribed circle: 2 A / perimeter. Scaled by the equilateral
    // triangle.
    const double in_radius = 2 * mesh.areas[i] / perimeter;
    const double regular = 2 * std::tan(std::numbers::pi / count);
    aspect = std::max(aspect, longest_edge(loop) / in_radius / regular);
    area += mesh.areas[i];
  }
  MeshReport& report = mesh.report;
  report.max_aspect = aspect;
  if (!angles.empty()) {
    const auto place = angles.begin() + static_cast<std::ptrdiff_t>(percentile * angles.size());
    std::nth_element(angles.begin(), place, angles.end());
    report.one_percent_angle = *place;
    report.min_angle = *std::min_element(angles.begin(), place + 1);
  }
  double scene_area = 0;
  report.sharpest_input_angle = 180;
  for (int i = 0; i < facets.size(); ++i) {
    const std::vector<Vec3> points = facets.points(i);
    scene_area += area_vector(points).norm() * (facets.front[i] + facets.back[i]);
    report.sharpest_input_angle = std::min(report.sharpest_input_angle, smallest_angle(points));
  }
  scene_area -= cut_area;
  report.area_error = std::abs(area - scene_area) / scene_area;
  report.welded_vertices = facets.welded_vertices;
  report.degenerate_faces = facets.degenerate_faces;
  report.duplicate_faces = facets.duplicate_faces;
  report.split_faces = facets.split_faces;
}

}  // namespace luxel
