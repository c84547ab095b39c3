#include "plan/cost_model.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "form_factors/visibility_choice.h"

namespace luxel {

namespace {

// An application streams the matrix once for every three columns, from memory [s an entry of the half], and
// multiplies.
constexpr double stream_float32 = 0.31e-9;
constexpr double stream_float64 = 0.55e-9;
constexpr double multiply = 0.065e-9;   // a column
constexpr double start_of_pass = 2e-5;  // tasks, partial sums
constexpr int columns_per_pass = 3;

// Factoring in float32 [s a multiplication and addition], and one column forth and back with its refinement
// [s an entry of the half].
constexpr double factor_step = 2.1e-11;
constexpr double substitution = 0.65e-9;
constexpr double start_of_factor = 3e-4;  // panels, tasks

// solve() applies the operator besides: the start, the check at the end, the error bound.
constexpr double applications_besides = 3;

// Starting the program; reading and cutting, and writing nothing [s a patch].
constexpr double start = 0.02;
constexpr double mesh_step = 1.3e-6;

// Rays of find_enclosures().
constexpr double enclosure_ray = 3e-7;

// A facing pair at accuracy 1e-3, and how much more each digit costs.
constexpr double facing_pair = 12e-9;
constexpr double pair_digit = 1.3;

// A pair that is clipped, for each face that hides from both sides, and for each that is seen of a convex
// body.
constexpr double clipped_pair = 1e-6, clipped_flat = 0.33e-6, clipped_body_face = 0.8e-6;

// A pair that rays decide, and one of a block that they sort, those in full sight counted.
constexpr double crowded_pair = 1.8e-6, sorted_pair = 1e-6;

// A pair of a patch and a part of the sky at accuracy 3e-2, growing as accuracy^-1/2 up to what clipping
// takes.
constexpr double sky_pair = 0.9e-6, clipped_sky_pair = 2.8e-6, sky_accuracy = 0.03;

// The same once it is known how many pairs and rays there were.
constexpr double any_clipped_pair = 2e-6, any_sampled_pair = 0.05e-6, any_ray = 0.06e-6;

// How much dearer rays that measure single pairs become with each doubling of the faces.
constexpr double few_faces = 64, dearer_a_doubling = 0.2;

// Passes over the matrix that close_rows() takes.
constexpr double closure_passes = 40;
constexpr double open_passes = 3;

// The program with its libraries loaded; patches, clusters, ray scene, three channels of everything and the
// writers' buffers [a patch].
constexpr double program_bytes = 12e6;
constexpr double patch_bytes = 2500;

// A ray of a gather: against few triangles, for each doubling of them, and from where they no longer fit the
// caches.
constexpr double gather_ray = 24e-9, ray_doubling = 2e-9;
constexpr double few_triangles = 64, cached_triangles = 1e5, beyond_cache = 0.5;

// A ray of the error bar goes alone, in double precision, and ends in memory of its own; so many times a ray
// of a gather, and what a patch costs it besides: places and strata.
constexpr double probe_ray = 7, probe_patch = 1.2e-7;
constexpr double cached_patches = 3e4, probe_beyond_cache = 0.1;

// A patch besides its rays: packets, pictures, direct light, iteration.
constexpr double gather_patch = 3e-6;

// Clusters and passes over them [s a patch], and pairs of clusters [s; times patches^growth accuracy^-order];
// or, once their number is known, all by what they hold [s a byte] and ask [s a ray]. Of their bytes the
// pairs' grow as the root of the patches.
constexpr double cluster_patch = 1.4e-6, cluster_pairs = 6.6e-4, cluster_growth = 0.22, cluster_order = 1.07;
constexpr double block_byte = 1.5e-8, block_ray = 3e-8;
constexpr double cluster_patch_bytes = 450, cluster_pair_bytes = 1200;

// Mesh, fields and pictures of a gather [a patch], and its ray scene [a triangle].
constexpr double gather_patch_bytes = 320, triangle_bytes = 230;

// Beyond this the factor's N^2 / 2 float32 numbers are 0.5 GB, and it would take hundreds of columns to pay.
constexpr double largest_factor = 16'000;

}  // namespace

int SolveShape::column_count() const {
  return std::accumulate(columns.begin(), columns.end(), 0);
}

double apply_seconds(double patches, int columns, Precision precision) {
  const double entries = patches * patches / 2;
  const double passes = std::ceil(static_cast<double>(columns) / columns_per_pass);
  const double stream = precision == Precision::float32 ? stream_float32 : stream_float64;
  return passes * (start_of_pass + entries * stream) + columns * entries * multiply;
}

double bounces_needed(double largest_reflectance, double tolerance) {
  if (largest_reflectance <= 0) return 0;
  if (largest_reflectance >= 1) return INFINITY;
  return std::max(0.0, std::ceil(std::log(tolerance) / std::log(largest_reflectance)) - 1);
}

// The light of a room is nearly uniform after a few bounces, so that all but one eigenvalue of K are small:
// the residual falls by exp(1.1) or more a step, however white the room. Fitted to reflectances of 0.5, 0.8,
// 0.9 and 0.999 (13, 15, 20 and 25 steps to 1e-12).
double cg_iterations(double mean_reflectance, double tolerance) {
  return std::max(1.0, std::ceil(-std::log(tolerance) / (1.1 + 2 * (1 - mean_reflectance))));
}

double solve_seconds(Method method, const SolveShape& shape) {
  const int columns = shape.column_count();
  const double apply = apply_seconds(shape.patches, columns, shape.precision);
  double seconds = applications_besides * apply;
  if (method == Method::cholesky) {
    const double n = shape.patches;
    for (const int group : shape.columns) {
      seconds += start_of_factor + n * n * n / 6 * factor_step + group * n * n / 2 * substitution;
    }
    return seconds;
  }
  const double iterations = method == Method::neumann
                                ? std::max(1.0, bounces_needed(shape.largest_reflectance, shape.tolerance))
                                : cg_iterations(shape.mean_reflectance, shape.tolerance);
  return seconds + iterations * apply;
}

double mesh_seconds(double patches) {
  return start + mesh_step * patches;
}

double enclosure_seconds(double rays) {
  return enclosure_ray * rays;
}

double assembly_seconds(double facing_pairs, double accuracy) {
  return facing_pairs * facing_pair * std::pow(pair_digit, std::max(0.0, -3 - std::log10(accuracy)));
}

double clipped_pair_seconds(double flat_faces, double body_faces) {
  return clipped_pair + clipped_flat * flat_faces + clipped_body_face * body_faces;
}

double crowded_pair_seconds() {
  return crowded_pair;
}

double sorted_pair_seconds() {
  return sorted_pair;
}

double few_rays_seconds(int rays, double faces) {
  const double doublings = std::log2(std::max(1.0, faces / few_faces));
  return 1e-6 * few_rays_cost(rays) * (1 + dearer_a_doubling * doublings);
}

double sky_seconds(double pairs, double accuracy) {
  return pairs * std::min(sky_pair * std::sqrt(sky_accuracy / accuracy), clipped_sky_pair);
}

double visibility_seconds(double clipped_pairs, double sampled_pairs, double rays) {
  return any_clipped_pair * clipped_pairs + any_sampled_pair * sampled_pairs + any_ray * rays;
}

double closure_seconds(double patches, Precision precision, bool closed) {
  return (closed ? closure_passes : open_passes) * apply_seconds(patches, 1, precision);
}

double gather_ray_seconds(double triangles) {
  const double doublings = std::log2(std::max(1.0, triangles / few_triangles));
  return (gather_ray + ray_doubling * doublings) *
         std::pow(std::max(1.0, triangles / cached_triangles), beyond_cache);
}

double probe_ray_seconds(double patches, double triangles) {
  return probe_ray * gather_ray_seconds(triangles) *
         std::pow(std::max(1.0, patches / cached_patches), probe_beyond_cache);
}

double probes_seconds(double patches) {
  return probe_patch * patches;
}

double gather_seconds(double patches, double rays_a_patch, double triangles) {
  return patches * (gather_patch + rays_a_patch * gather_ray_seconds(triangles));
}

double hierarchical_seconds(double patches, double accuracy) {
  return patches * cluster_patch +
         cluster_pairs * std::pow(patches, cluster_growth) * std::pow(accuracy, -cluster_order);
}

double block_seconds(double bytes, double rays) {
  return block_byte * bytes + block_ray * rays;
}

double hierarchical_bytes(double patches, double accuracy) {
  return program_bytes + cluster_patch_bytes * patches +
         cluster_pair_bytes * std::sqrt(patches) * std::pow(accuracy, -cluster_order);
}

double gather_bytes(double patches, double triangles) {
  return program_bytes + gather_patch_bytes * patches + triangle_bytes * triangles;
}

double mesh_bytes(double patches) {
  return program_bytes + patch_bytes * patches;
}

double operator_bytes(double patches, Precision precision) {
  return patches * (patches - 1) / 2 * (precision == Precision::float32 ? 4 : 8);
}

double factor_bytes(double patches, Method method) {
  if (method == Method::cholesky) return patches * (patches + 1) / 2 * 8;
  if (method == Method::lu) return patches * patches * 8;
  return 0;
}

Method cheapest_method(const SolveShape& shape) {
  Method best = Method::neumann;
  double least = solve_seconds(best, shape);
  const auto consider = [&](Method method) {
    const double seconds = solve_seconds(method, shape);
    if (!(seconds < least)) return;
    best = method;
    least = seconds;
  };
  consider(Method::cg);
  if (shape.entries && shape.patches <= largest_factor) consider(Method::cholesky);
  return best;
}

}  // namespace luxel
