#pragma once

#include <vector>

#include "luxel/exchange_matrix.h"
#include "luxel/solve.h"

// What the stages cost [CPU seconds]; docs/plan.md tells where and how the constants were measured.
namespace luxel {

/// A system as far as the cost of solving it goes.
struct SolveShape {
  double patches = 0;
  std::vector<int> columns;        ///< right-hand sides of each reflectance
  double mean_reflectance = 0;     ///< weighted by area, of the brightest column
  double largest_reflectance = 0;  ///< of any patch and column
  double tolerance = 1e-6;         ///< relative residual asked for
  Precision precision = Precision::float32;
  bool entries = true;  ///< Cholesky has what it needs

  int column_count() const;
};

/// One application of a dense operator.
double apply_seconds(double patches, int columns, Precision precision);

/// Bounces after which the relative residual is proven to be at most `tolerance`: rho^(K + 1), since F never
/// lengthens in the area-weighted norm (it is symmetric there, with rows that sum to 1 at most).
double bounces_needed(double largest_reflectance, double tolerance);

/// Iterations of conjugate gradients, about.
double cg_iterations(double mean_reflectance, double tolerance);

/// All of solve() by cg, neumann or cholesky.
double solve_seconds(Method method, const SolveShape& shape);

/// Reading and cutting a scene, and the start of the program.
double mesh_seconds(double patches);
double enclosure_seconds(double rays);

/// Form factors of so many facing pairs, as if nothing hid them.
double assembly_seconds(double facing_pairs, double accuracy);

/// A pair that is clipped by so many flat faces and faces of convex bodies in sight.
double clipped_pair_seconds(double flat_faces, double body_faces);

/// A pair that rays decide because many occluders stand between, and one of a block that rays sort as a
/// whole.
double crowded_pair_seconds();
double sorted_pair_seconds();

/// A pair that so many rays measure, without more ado, among so many faces.
double few_rays_seconds(int rays, double faces);

/// Pairs of a patch and a part of the sky.
double sky_seconds(double pairs, double accuracy);

/// Pairs that were clipped or measured by rays, once their numbers are known.
double visibility_seconds(double clipped_pairs, double sampled_pairs, double rays);

/// Row sums, and scaling them in a closed enclosure.
double closure_seconds(double patches, Precision precision, bool closed);

/// A ray of a gather, with what is done with it, against so many triangles.
double gather_ray_seconds(double triangles);

/// The error bar: a ray of its probes, and what it does before the first.
double probe_ray_seconds(double patches, double triangles);
double probes_seconds(double patches);

/// Everything that a gather does.
double gather_seconds(double patches, double rays_a_patch, double triangles);

/// Everything that a hierarchical operator does, in a scene of few polygons.
double hierarchical_seconds(double patches, double accuracy);
/// Assembling and solving a hierarchical operator of so many bytes that took so many rays.
double block_seconds(double bytes, double rays);

// Memory [bytes].
double hierarchical_bytes(double patches, double accuracy);
double gather_bytes(double patches, double triangles);
double mesh_bytes(double patches);
double operator_bytes(double patches, Precision precision);
double factor_bytes(double patches, Method method);

/// The cheapest of the three, bounces where they cost the same; cholesky only where it can be had.
Method cheapest_method(const SolveShape& shape);

}  // namespace luxel
