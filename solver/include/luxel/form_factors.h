#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "luxel/exchange_matrix.h"
#include "luxel/patch_mesh.h"
#include "luxel/progress.h"

namespace luxel {

enum class Visibility {
  automatic,  ///< per pair the cheaper of the two that reaches the accuracy
  rays,       ///< adaptive rays between quasi-random points of partly hidden pairs
  exact       ///< clipping against every blocker; no sampling
};

struct FormFactorOptions {
  double accuracy = 1e-3;  ///< A: raw row errors RMS <= A and largest <= 2 A; in [1e-8, 0.1]
  Visibility visibility = Visibility::automatic;
  /// Hold the factors between groups to A as well, each relative to itself, or to 1e-3 where it is smaller.
  bool group_accuracy = false;
  Precision precision = Precision::float32;  ///< of the stored entries; they are computed in float64
  std::uint64_t seed = 1;                    ///< of the rays' random streams
  bool sky_shares = false;                   ///< find what of each patch's view the scene leaves free too
  bool keep_idle_occluders = false;  ///< look at those too that can hide nothing: as right, and slower
};

/// What the assembly did, pair by pair, and what it may be wrong by.
struct FormFactorReport {
  std::int64_t pairs = 0;          ///< N (N - 1) / 2
  std::int64_t facing_pairs = 0;   ///< that see each other where nothing hides
  std::int64_t hidden_pairs = 0;   ///< proven wholly hidden
  std::int64_t partial_pairs = 0;  ///< looked at one by one
  std::int64_t exact_pairs = 0;    ///< of these, clipped
  std::int64_t sampled_pairs = 0;  ///< of these, by rays
  std::int64_t rays = 0;
  int occluders = 0;  ///< convex polygons that can hide anything; 0: no ray was cast, nothing clipped
  double estimated_error = 0;  ///< of a row sum, RMS, from the rules' own error estimates
};

/// Exchange areas of all pairs with the report of how they came about.
struct FormFactors {
  ExchangeMatrix exchange_areas;
  FormFactorReport report;  ///< but for `pairs` with those of the sky, where it was asked for
  /// N, where asked for: form factors from each patch to the sky, found as those between patches are and as
  /// accurate, and not from the row sums. The other way round a row is as wrong as its sum and this miss 1 by
  /// where a patch sees no backs.
  std::vector<double> sky_shares;
};

/// Form factors of every pair of patches with visibility, raw: nothing is corrected afterwards. The same bits
/// for any number of threads. Cost: about 6 ns a pair where nothing hides, 2 us for each partly hidden pair.
/// @throws std::invalid_argument for an accuracy out of range; Cancelled; std::bad_alloc
FormFactors form_factors(const PatchMesh& mesh, const FormFactorOptions& options = {},
                         const Progress& progress = {});

/// Exchange area A_a F_ab [m2] of two flat convex polygons with nothing between them, each given by its
/// corners counter-clockwise seen from the front (3 to 8), to 1e-9 relative or better: touching, straddling
/// each other's plane, slivers and far apart included. Source: contour form of Sparrow 1963; Schroeder and
/// Hanrahan 1993.
double exchange_area(std::span<const Vec3> a, std::span<const Vec3> b);

/// Share of the flux that leaves an infinitesimal patch at `point` with unit `normal` and arrives on the
/// front of the polygon, nothing between. Exact (Lambert 1760): the polygon is clipped by the point's horizon
/// first.
double point_form_factor(const Vec3& point, const Vec3& normal, std::span<const Vec3> polygon);

}  // namespace luxel
