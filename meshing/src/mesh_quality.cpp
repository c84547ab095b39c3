#include "mesh_quality.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "angle.h"
#include "corner_positions.h"
#include "polygon.h"

namespace luxel {

namespace {

// Share of the patches that may be sharper than one_percent_angle.
constexpr double percentile = 0.01;

// Patches or facets that a thread takes at a time, at least.
constexpr int measured_per_task = 2048;

double smallest_angle(std::span<const Vec3> loop) {
  const std::size_t n = loop.size();
  double smallest = 180;
  for (std::size_t i = 0; i < n; ++i) {
    smallest = std::min(smallest, degrees_per_radian * angle_between(loop[(i + 1) % n] - loop[i],
                                                                     loop[(i + n - 1) % n] - loop[i]));
  }
  return smallest;
}

/// The largest value that measure(i, corners) gives for i in 0 .. count - 1, at least -180; `corners` looks
/// up positions among `vertices`.
template <class Measure>
double largest_of(int count, const std::vector<Vec3>& vertices, const Measure& measure) {
  using Range = tbb::blocked_range<int>;
  return tbb::parallel_reduce(
      Range(0, count, measured_per_task), -180.0,
      [&](const Range& range, double largest) {
        CornerPositions corners(vertices);
        for (int i = range.begin(); i < range.end(); ++i) largest = std::max(largest, measure(i, corners));
        return largest;
      },
      [](double a, double b) { return std::max(a, b); });
}

}  // namespace

void measure_quality(PatchMesh& mesh, const Facets& facets, double cut_area) {
  std::vector<double> angles(mesh.size());
  MeshReport& report = mesh.report;
  report.max_aspect = largest_of(mesh.size(), mesh.vertices, [&](int i, CornerPositions& corners) {
    const int count = mesh.corner_count(i);
    const std::span<const Vec3> loop = corners(std::span(mesh.corners[i]).first(count));
    double perimeter = 0;
    for (int k = 0; k < count; ++k) perimeter += (loop[(k + 1) % count] - loop[k]).norm();
    angles[i] = smallest_angle(loop);
    // In-radius of a polygon that has an inscribed circle: 2 A / perimeter. Scaled by the equilateral
    // triangle.
    const double in_radius = 2 * mesh.areas[i] / perimeter;
    const double regular = 2 * std::tan(std::numbers::pi / count);
    return longest_edge(loop) / in_radius / regular;
  });
  if (!angles.empty()) {
    const auto place = angles.begin() + static_cast<std::ptrdiff_t>(percentile * angles.size());
    std::nth_element(angles.begin(), place, angles.end());
    report.one_percent_angle = *place;
    report.min_angle = *std::min_element(angles.begin(), place + 1);
  }
  std::vector<double>& areas = angles;  // of the facets: the angles are no longer needed
  areas.resize(facets.size());
  report.sharpest_input_angle =
      -largest_of(facets.size(), facets.vertices, [&](int i, CornerPositions& corners) {
        const std::span<const Vec3> points = corners(facets.loop(i));
        areas[i] = area_vector(points).norm() * (facets.front[i] + facets.back[i]);
        return -smallest_angle(points);
      });
  const double scene_area = std::accumulate(areas.begin(), areas.end(), 0.0) - cut_area;
  report.area_error = std::abs(total_area(mesh) - scene_area) / scene_area;
  report.welded_vertices = facets.welded_vertices;
  report.degenerate_faces = facets.degenerate_faces;
  report.duplicate_faces = facets.duplicate_faces;
  report.split_faces = facets.split_faces;
}

}  // namespace luxel
