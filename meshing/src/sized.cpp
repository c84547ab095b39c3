#include "sized.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "angle.h"
#include "face_locator.h"
#include "luxel/input_error.h"
#include "patch_builder.h"
#include "patch_limit.h"
#include "sized_mesher.h"
#include "sizing_search.h"
#include "t_junctions.h"

namespace luxel {

namespace {

// Angles that the fill shall not fall below [degrees], the widest first: narrower ones are taken where a
// scene of narrow parts cannot have the wider ones with the patches asked for. Refinement is sure to end up
// to 20.7 degrees and ends in practice up to about 30.
constexpr std::array smallest_angles = {25.0, 20.0, 15.0, 10.0, 5.0, 0.0};

// How near the number of patches of a finished fill must come, relative; what is promised; how many fills the
// search may make for one angle.
constexpr double fill_tolerance = 0.02;
constexpr double promised_tolerance = 0.05;
constexpr int fill_trials = 10;

// Longest edge of a fill over its edge length, about: the first guess for patch_size.
constexpr double longest_over_edge_length = 1.45;

// How much more than the ratio says the edge length is shortened with each trial for patch_size, since the
// longest edge follows it in steps; how many trials there may be; by how much parts of edges are shorter than
// asked, for the sake of rounding.
constexpr double trial_step = 0.001;
constexpr int trials = 12;
constexpr double spare = 1e-9;

double radiating_area(const Facets& facets) {
  const std::vector<Vec3> areas = facet_areas(facets);
  double total = 0;
  for (int i = 0; i < facets.size(); ++i) total += areas[i].norm() * (facets.front[i] + facets.back[i]);
  return total;
}

/// Edge length [m] of n equilateral triangles of this area together.
double equilateral_edge(double area, double n) {
  return std::sqrt(4 * area / (std::sqrt(3.0) * n));
}

double longest_edge(const Filled& filled) {
  double longest = 0;
  for (const auto& t : filled.triangles) {
    for (int k = 0; k < 3; ++k) {
      longest = std::max(longest, (filled.vertices[t[(k + 1) % 3]] - filled.vertices[t[k]]).squaredNorm());
    }
  }
  return std::sqrt(longest);
}

struct Sized {
  Filled filled;
  Sizing sizing;
  double error = std::numeric_limits<double>::infinity();  // of the count, relative
};

/// A fill of about n patches. What grading adds to it is known only once it is made: the search then aims
/// that much lower.
Sized fill_with_angle(SizedMesher& mesher, double guess, double n, double smallest_angle,
                      const std::function<void(double)>& refuse, const Progress& progress) {
  Sized best;
  Sizing sizing = {guess, guess, 0};
  double aim = n;
  double too_few = 0;  // aims
  double too_many = std::numeric_limits<double>::infinity();
  for (int trial = 0; trial < fill_trials; ++trial) {
    sizing = find_sizing(mesher, sizing.edge_length, aim);
    const double expected = mesher.count(sizing);
    refuse(expected);
    Filled filled = mesher.fill(sizing, smallest_angle, progress);
    const double found = mesher.count(filled);
    const bool again = filled.graded && filled.complete;
    const double error = std::abs(found / n - 1);
    if (error < best.error) best = {std::move(filled), sizing, error};
    // Fewer than the coarsest triangles cannot be had, however low the aim.
    const bool coarsest = expected > (1 + promised_tolerance) * aim;
    if (error <= fill_tolerance || !again || (coarsest && found > n)) break;
    (found > n ? too_many : too_few) = aim;
    aim *= n / found;
    if (!(aim > too_few && aim < too_many)) aim = 0.5 * (too_few + too_many);
  }
  return best;
}

/// A fill of about n patches with angles as wide as that allows.
Sized fill_by_count(SizedMesher& mesher, double guess, double n, const std::function<void(double)>& refuse,
                    const Progress& progress) {
  Sized best;
  for (const double angle : smallest_angles) {
    if (!best.filled.complete && angle > 0) continue;
    Sized sized = fill_with_angle(mesher, guess, n, angle / degrees_per_radian, refuse, progress);
    const bool graded = sized.filled.graded;
    if (sized.error < best.error || !best.filled.complete) best = std::move(sized);
    if (best.filled.complete && (best.error <= promised_tolerance || !graded)) break;
  }
  return best;
}

/// A fill with no edge longer than `longest`.
Sized fill_by_size(SizedMesher& mesher, double longest, const std::function<void(double)>& refuse,
                   const Progress& progress) {
  Sized sized;
  sized.sizing.longest = (1 - spare) * longest;
  double& edge_length = sized.sizing.edge_length;
  edge_length = longest / longest_over_edge_length;
  double angle = smallest_angles.front() / degrees_per_radian;
  for (int trial = 0; trial < trials; ++trial) {
    refuse(mesher.count(sized.sizing));
    sized.filled = mesher.fill(sized.sizing, angle, progress);
    if (!sized.filled.complete) {
      angle = 0;
      sized.filled = mesher.fill(sized.sizing, angle, progress);
    }
    const double found = longest_edge(sized.filled);
    if (found <= longest) break;
    edge_length *= (1 - std::ldexp(trial_step, trial)) * longest / found;
  }
  return sized;
}

void append(PatchMesh& mesh, const Scene& scene, const Facets& facets, const MergedPolygons& merged,
            const std::vector<int>& polygon_of_facet, const Filled& filled) {
  std::vector<int> index(filled.vertices.size(), -1);
  reserve_patches(mesh, filled.triangles.size());
  for (std::size_t begin = 0, end = 0; begin < filled.triangles.size(); begin = end) {
    const int p = filled.polygons[begin];
    while (end < filled.triangles.size() && filled.polygons[end] == p) ++end;
    const auto members = merged.regions[p];
    const int facet = members[0];
    const FaceLocator locator(facets, members, merged.polygons.frames[p]);
    for (const bool front : {true, false}) {
      if (!(front ? facets.front : facets.back)[facet]) continue;
      for (std::size_t i = begin; i < end; ++i) {
        std::array<int, 3> corners = filled.triangles[i];
        Vec3 centre = Vec3::Zero();
        for (int& corner : corners) {
          centre += filled.vertices[corner] / 3;
          if (index[corner] < 0) {
            index[corner] = static_cast<int>(mesh.vertices.size());
            mesh.vertices.push_back(filled.vertices[corner]);
          }
          corner = index[corner];
        }
        if (!front) std::swap(corners[1], corners[2]);
        append_patch(mesh, scene, corners, locator.face_at(centre), polygon_of_facet[facet]);
      }
    }
  }
}

}  // namespace

void append_sized(PatchMesh& mesh, const Scene& scene, const Facets& facets, const EdgeTable& edges,
                  const std::vector<int>& polygon_of_facet, const MeshingOptions& options,
                  const Progress& progress) {
  const double area = radiating_area(facets);
  const bool by_size = options.patch_size > 0;
  const int wanted = options.patches > 0 ? options.patches : MeshingOptions::default_patches;
  const double guess =
      by_size ? options.patch_size / longest_over_edge_length : equilateral_edge(area, wanted);
  // The smallest number that this size can give, before anything is made.
  const double at_least =
      by_size ? area / (std::sqrt(3.0) / 4 * options.patch_size * options.patch_size) : wanted;
  const auto refuse = [&](double count) { refuse_too_many(scene, count, options.max_patches); };
  refuse(at_least);

  SizedMesher mesher(scene, facets, edges, guess, options.crease_angle);
  const Sized sized = by_size ? fill_by_size(mesher, options.patch_size, refuse, progress)
                              : fill_by_count(mesher, guess, wanted, refuse, progress);
  append(mesh, scene, facets, mesher.plan().merged, polygon_of_facet, sized.filled);
  mesh.report.edge_length = sized.sizing.edge_length;
  mesh.report.imprinted_edges = mesher.plan().contact_edges;
}

}  // namespace luxel
