#include "sized_mesher.h"

#include "graded_fill.h"
#include "luxel/input_error.h"

namespace luxel {

namespace {

// Longest edge of halved triangles, in edge lengths of the lattice, at which both have about the same area.
constexpr double longest_of_halved = 1.5;

}  // namespace

SizedMesher::SizedMesher(const Scene& scene, const Facets& facets, const EdgeTable& edges, double guess,
                         double crease_angle)
    : facets_(facets), plan_(plan_surface(scene, facets, edges, guess, crease_angle)) {}

double SizedMesher::sides(int p) const {
  const int facet = plan_.merged.regions[p][0];
  return facets_.front[facet] + facets_.back[facet];
}

double SizedMesher::count(const Sizing& sizing) {
  double total = 0;
  const PolygonFiller filler(facets_.vertices, plan_);
  for (const int p : plan_.filled) total += sides(p) * filler.count(p, sizing);
  if (!plan_.halved.empty()) {
    const std::size_t made = halvings(sizing);
    total += sides_of_halved_ * static_cast<double>(trial_->count(made));
  }
  return total;
}

double SizedMesher::count(const Filled& filled) const {
  double total = 0;
  for (const int p : filled.polygons) total += sides(p);
  return total;
}

Filled SizedMesher::fill(const Sizing& sizing, double smallest_angle, const Progress& progress) {
  Filled result;
  result.vertices = facets_.vertices;
  LongestEdgeRefiner refiner = halving(result.vertices);
  if (!plan_.halved.empty()) refiner.halve(halvings(sizing));
  plan_.edges.divide(
      result.vertices,
      [&](int edge, double length) { return sizing.parts(length, plan_.turns.of_edge[edge]); },
      [&](int a, int b) { return refiner.points_between(a, b); });
  PolygonFiller filler(facets_.vertices, plan_);
  std::vector<PolygonFill> fills;
  const double total = static_cast<double>(plan_.filled.size());
  for (const int p : plan_.filled) {
    fills.push_back(filler.fill(p, sizing, result.vertices));
    if (progress && !progress("meshing", static_cast<double>(fills.size()), total)) throw Cancelled();
  }
  const GradedFills graded = grade(std::move(fills), smallest_angle, plan_, filler, result.vertices);
  result.graded = graded.added > 0;
  result.complete = graded.complete;
  for (const PolygonFill& fill : graded.fills) {
    result.triangles.insert(result.triangles.end(), fill.triangles.begin(), fill.triangles.end());
    result.polygons.insert(result.polygons.end(), fill.triangles.size(), fill.polygon);
  }
  const auto halves = refiner.triangles();
  const auto tags = refiner.tags();
  result.triangles.insert(result.triangles.end(), halves.begin(), halves.end());
  result.polygons.insert(result.polygons.end(), tags.begin(), tags.end());
  return result;
}

LongestEdgeRefiner SizedMesher::halving(std::vector<Vec3>& vertices) const {
  const int count = static_cast<int>(vertices.size());
  return {vertices, make_split_meshes(plan_.halved, plan_.polygon_of_halved, count), plan_.watched};
}

/// How many edges of the halved parts a sizing halves: of those that its two lengths tell apart, the longest
/// ones.
std::size_t SizedMesher::halvings(const Sizing& sizing) {
  const bool mixed = sizing.share > 0;
  const double longest = longest_of_halved * (mixed ? sizing.finer : sizing.edge_length);
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
  const std::size_t all = trial_->halvings(longest);
  if (!mixed) return all;
  const std::size_t some = trial_->halvings(longest_of_halved * sizing.edge_length);
  return some + static_cast<std::size_t>(sizing.share * static_cast<double>(all - some));
}

}  // namespace luxel
