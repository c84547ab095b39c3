#include "sized.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "face_locator.h"
#include "longest_edge.h"
#include "luxel/input_error.h"
#include "patch_builder.h"
#include "patch_limit.h"
#include "polygon_fill.h"
#include "surface_plan.h"
#include "t_junctions.h"

namespace luxel {

namespace {

// Longest edge of halved triangles, in edge lengths of the lattice, at which both have about the same area.
constexpr double longest_of_halved = 1.5;

// How near the number of patches must come to what is asked, relative; half of what is promised.
constexpr double count_tolerance = 0.01;

// Trials that the search for an edge length may take; the count is no smooth function of it for few patches.
constexpr int trials = 12;

// Longest edge of a fill over its edge length, about: the first guess for patch_size.
constexpr double longest_over_edge_length = 1.45;

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

struct Filled {
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> polygons;
};

class SizedMesher {
 public:
  SizedMesher(const Scene& scene, const Facets& facets, double guess, double crease_angle)
      : facets_(facets), plan_(plan_surface(scene, facets, guess, crease_angle)) {}

  /// How many patches an edge length gives, about.
  double count(double edge_length) {
    double total = 0;
    const PolygonFiller filler(facets_.vertices, plan_);
    for (const int p : plan_.filled) total += sides(p) * filler.count(p, edge_length);
    if (!plan_.halved.empty()) total += count_halved(longest_of_halved * edge_length);
    return total;
  }

  Filled fill(double edge_length, const Progress& progress) {
    Filled result;
    result.vertices = facets_.vertices;
    LongestEdgeRefiner refiner = halving(result.vertices);
    refiner.refine(longest_of_halved * edge_length);
    plan_.edges.divide(result.vertices, edge_length,
                       [&](int a, int b) { return refiner.points_between(a, b); });
    PolygonFiller filler(facets_.vertices, plan_);
    int done = 0;
    for (const int p : plan_.filled) {
      for (const auto& triangle : filler.fill(p, edge_length, result.vertices)) {
        result.triangles.push_back(triangle);
        result.polygons.push_back(p);
      }
      if (progress && !progress("meshing", ++done, static_cast<double>(plan_.filled.size())))
        throw Cancelled();
    }
    const auto halves = refiner.triangles();
    const auto tags = refiner.tags();
    result.triangles.insert(result.triangles.end(), halves.begin(), halves.end());
    result.polygons.insert(result.polygons.end(), tags.begin(), tags.end());
    return result;
  }

  const SurfacePlan& plan() const { return plan_; }

 private:
  double sides(int p) const {
    const int facet = plan_.merged.regions[p][0];
    return facets_.front[facet] + facets_.back[facet];
  }

  LongestEdgeRefiner halving(std::vector<Vec3>& vertices) const {
    const int count = static_cast<int>(vertices.size());
    return {vertices, make_split_meshes(plan_.halved, plan_.polygon_of_halved, count), plan_.watched};
  }

  double count_halved(double longest) {
    if (!trial_) {
      trial_vertices_ = facets_.vertices;
      trial_.emplace(halving(trial_vertices_));
    }
    if (longest < finest_) {
      trial_->refine(longest);
      finest_ = longest;
      const std::vector<int> tags = trial_->tags();
      double weighted = 0;
      for (const int p : tags) weighted += sides(p);
      sides_of_halved_ = weighted / static_cast<double>(tags.size());
    }
    return sides_of_halved_ * static_cast<double>(trial_->count(longest));
  }

  const Facets& facets_;
  SurfacePlan plan_;
  std::vector<Vec3> trial_vertices_;
  std::optional<LongestEdgeRefiner> trial_;
  double finest_ = std::numeric_limits<double>::infinity();  // longest edge of the trial
  double sides_of_halved_ = 1;
};

/// The edge length that gives about n patches.
double find_edge_length(SizedMesher& mesher, double guess, double n) {
  double best = guess;
  double best_error = std::numeric_limits<double>::infinity();
  double low = 0;  // gives too many
  double high = std::numeric_limits<double>::infinity();
  double edge_length = guess;
  for (int trial = 0; trial < trials; ++trial) {
    const double found = mesher.count(edge_length);
    const double error = std::abs(found / n - 1);
    if (error < best_error) {
      best_error = error;
      best = edge_length;
    }
    if (error <= count_tolerance) break;
    (found > n ? low : high) = edge_length;
    double next = edge_length * std::sqrt(found / n);
    if (!(next > low && next < high)) next = std::isfinite(high) ? 0.5 * (low + high) : 2 * low;
    edge_length = next;
  }
  return best;
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

void append_sized(PatchMesh& mesh, const Scene& scene, const Facets& facets,
                  const std::vector<int>& polygon_of_facet, const MeshingOptions& options,
                  const Progress& progress) {
  const double area = radiating_area(facets);
  const bool by_size = options.patch_size > 0;
  const int wanted = options.patches > 0 ? options.patches : MeshingOptions::default_patches;
  double edge_length =
      by_size ? options.patch_size / longest_over_edge_length : equilateral_edge(area, wanted);
  // The smallest number that this size can give, before anything is made.
  const double at_least =
      by_size ? area / (std::sqrt(3.0) / 4 * options.patch_size * options.patch_size) : wanted;
  refuse_too_many(scene, at_least, options.max_patches);

  SizedMesher mesher(scene, facets, edge_length, options.crease_angle);
  if (!by_size) edge_length = find_edge_length(mesher, edge_length, wanted);
  refuse_too_many(scene, mesher.count(edge_length), options.max_patches);
  Filled filled = mesher.fill(edge_length, progress);
  for (int trial = 0; by_size && trial < trials; ++trial) {
    const double longest = longest_edge(filled);
    if (longest <= options.patch_size) break;
    // A hair less than what the ratio says, so that rounding does not ask for one more trial.
    edge_length *= 0.999 * options.patch_size / longest;
    refuse_too_many(scene, mesher.count(edge_length), options.max_patches);
    filled = mesher.fill(edge_length, progress);
  }
  append(mesh, scene, facets, mesher.plan().merged, polygon_of_facet, filled);
  mesh.report.edge_length = edge_length;
  mesh.report.imprinted_edges = mesher.plan().contact_edges;
}

}  // namespace luxel
