#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "luxel/patch_mesh.h"
#include "luxel/progress.h"
#include "luxel/ray_scene.h"
#include "luxel/solve.h"

namespace luxel {

struct OperatorErrorOptions {
  double accuracy = 1e-3;  ///< asked of the operator, in (0, 1): errors far below it are not looked for
  double most_rays = 2e6;  ///< about, of all probes together; 192 probes of 64 rays are the least
  std::uint64_t seed = 0;  ///< of rays that are independent of all that solved the scene
};

/// How far the irradiance is from that of an exact operator on the same patches.
struct OperatorError {
  double estimate = 0;       ///< area-weighted relative RMS error of irradiance, worst channel
  double low = 0, high = 0;  ///< the true error lies between them in 95 of 100 runs; low = 0: not seen
  int probes = 0;            ///< patches whose irradiance was gathered anew
  std::int64_t rays = 0;     ///< cast for them
  /// Of the probes: how far the row sums given are from 1 less the share of rays that met no patch.
  double row_sum_error_max = 0, row_sum_error_rms = 0;

  /// Whether this tells that an accuracy was missed: low is above it, and above a quarter of high. A lower
  /// end is that of an interval that has seen little, and noise may have made it.
  bool surely_above(double accuracy) const { return low > accuracy && low > 0.25 * high; }
};

/// Estimates the error that the transport operator F_s of a solution causes, without knowing it. With e = H -
/// H* and F exact, e = d + F rho e, where d = H - F B is measured: on patches drawn at random from strata,
/// the irradiance from the solution's own B is gathered by rays of its own, in two independent halves, so
/// that their noise cancels from d^2. Rays are settled in double precision, and lamps met by rays over the
/// hemisphere and by points drawn on them, by no code of the operators. F rho e is what the errors' smooth
/// part brings back; it is carried over by exchange areas between 64 parts of the scene. The interval comes
/// from the jackknife over strata. Cost: about 0.2 us a ray, 0.3 at a million patches, and 0.1 us a patch.
/// Source: Kish 1965, Survey Sampling (strata); Efron and Stein 1981 (jackknife); Veach and Guibas 1995
/// (balance heuristic).
///
/// @param solution  of a converged solve with all bounces; irradiance = F_s B
/// @param row_sums  N: of the operator; empty: their errors are left 0
/// @throws std::invalid_argument for shapes and ranges; Cancelled
OperatorError operator_error(const PatchMesh& mesh, const RayScene& occluders, const PatchField& reflectance,
                             const PatchField& emission, const RadiositySolution& solution,
                             std::span<const double> row_sums, const OperatorErrorOptions& options = {},
                             const Progress& progress = {});

}  // namespace luxel
