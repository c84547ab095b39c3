#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "luxel/patch_mesh.h"
#include "luxel/progress.h"
#include "luxel/ray_scene.h"
#include "luxel/solve.h"
#include "luxel/transport_operator.h"
#include "luxel/vector.h"

namespace luxel {

/// How the irradiance is gathered by rays. The door for most users is solve_gathered().
struct GatherOptions {
  /// asked relative RMS error of single patches' irradiance, in (0, 1); sets the rays: from a usual law,
  /// then, in solve_gathered(), from the noise that a sample of packets shows
  double accuracy = 0.01;
  std::optional<int> rays = {};  ///< rays from each patch, >= 16; overrides `accuracy`
  std::optional<int> stored_rays =
      {};  ///< of these kept to iterate on, >= 16; by default a quarter, see gather_plan
  std::optional<int> shadow_rays = {};  ///< from a patch to a lamp that it sees in part, >= 16
  bool keep_partial = false;            ///< see GatherReport::partial
  bool fit = true;                      ///< smooth the noise between neighbours on one plane where they agree
  std::uint64_t seed = 0;               ///< another seed, another sample of the same error
};

/// What solve_gathered() will do for a mesh.
struct GatherPlan {
  int rays = 0;               ///< from each patch
  int stored_rays = 0;        ///< the first of them, kept as 4-byte patch numbers
  int shadow_rays = 0;        ///< from a patch to each lamp that it sees in part
  bool direct_apart = false;  ///< emitters are sampled by themselves; false: they are met by the rays
  std::size_t bytes = 0;      ///< memory of the solver at its peak, beside the mesh and the fields given
};

/// @param emission  N x m, which patches emit
/// @throws std::invalid_argument for shapes and ranges
GatherPlan gather_plan(const PatchMesh& mesh, const PatchField& emission, const GatherOptions& options = {});

/// F by quasi-random rays: row i holds the shares of patch i's rays that met each patch. Rows are exactly 1
/// where no ray is lost (always in closed enclosures); a ray that escapes or meets a back brings nothing. Not
/// symmetric: reciprocity holds within the sampling error. Error of F X: about 0.5 rays^-0.67 of a smooth
/// X's variation; see docs/decisions/0010-gather.md.
class GatherOperator : public TransportOperator {
 public:
  /// Lanes of a packet: patches whose rays are traced together.
  static constexpr int lanes = 16;
  using Packet = std::array<int, lanes>;  ///< patches; -1: an idle lane

  /// @param hits  packets x rays x lanes: the patch met, or areas.size() for none
  GatherOperator(std::vector<Packet> packets, int rays, std::unique_ptr<std::uint32_t[]> hits,
                 std::vector<double> areas);

  int size() const override { return static_cast<int>(areas_.size()); }
  void apply(const double* x, double* y, int columns) const override;
  std::span<const double> row_sums() const override { return row_sums_; }
  std::span<const double> areas() const override { return areas_; }
  bool symmetric() const override { return false; }
  std::size_t bytes() const override;
  std::string_view kind() const override { return "gather"; }

  /// Rays from each patch.
  int rays() const { return rays_; }
  std::span<const Packet> packets() const { return packets_; }
  /// What the rays of one packet met, rays x lanes, in the order of tracing.
  std::span<const std::uint32_t> hits(std::size_t packet) const;

 private:
  std::vector<Packet> packets_;
  int rays_;
  std::unique_ptr<std::uint32_t[]> hits_;
  std::vector<double> areas_;
  std::vector<double> row_sums_;
};

/// The operator with all `rays` of the options stored, to be used with solve(). Emission given to solve() is
/// then met by chance like any other light: right, but with much more noise than of solve_gathered() where
/// lamps are small. Memory: 4 bytes a ray.
/// @throws std::invalid_argument for options out of range or a mesh that does not belong to the others;
/// Cancelled
std::unique_ptr<GatherOperator> gather_operator(const PatchMesh& mesh, const RayScene& occluders,
                                                const GatherOptions& options = {},
                                                const Progress& progress = {});

/// Light that arrives straight from the emitters.
struct DirectLight {
  PatchField irradiance;  ///< N x m [W/m2]
  std::int64_t rays = 0;  ///< shadow rays cast
  int partly_lit = 0;     ///< patches that see some lamp in part, or may
};

/// Irradiance from the emitters alone: the contour integral of each unoccluded lamp (Lambert 1760) times the
/// share of it that shadow rays find visible. Rays are few where they agree, `shadow_rays` where a patch or
/// one that shares a corner with it sees a lamp in part. A lamp is what emits alike on one side of one flat
/// polygon.
/// @param emission  N x m [W/m2]
/// @throws std::invalid_argument for shapes and ranges; Cancelled
DirectLight direct_irradiance(const PatchMesh& mesh, const RayScene& occluders, const PatchField& emission,
                              const GatherOptions& options = {}, const Progress& progress = {});

/// What solve_gathered() did.
struct GatherReport {
  GatherPlan plan;
  std::int64_t rays = 0;         ///< traced from the patches
  std::int64_t shadow_rays = 0;  ///< traced to the emitters
  std::int64_t asked_twice = 0;  ///< rays that float left in doubt, settled in double precision
  int partly_lit = 0;            ///< patches in or next to a penumbra
  double smoothed = 0;           ///< mean share by which the packets followed their fit, in [0, 1]
  /// Stopped by on_iteration, or (with keep_partial, instead of Cancelled) by progress after the iteration:
  /// the light is that of the stored rays alone.
  bool partial = false;
  std::size_t bytes = 0;  ///< held for the rays: those kept, and the map from hits to patches
};

/// Radiosity and irradiance with how they were gathered; `light.report` is that of the iteration on the
/// stored rays.
struct GatheredSolution {
  RadiositySolution light;
  PatchField direct;  ///< N x m: the irradiance straight from the emitters; empty where it was not apart
  std::vector<double> row_sums;  ///< N: share of all rays of each patch that met a patch
  GatherReport report;
};

/// Solves B = E + rho F B with a gathered F: direct light D apart, then U = rho (D + F U) iterated on a few
/// stored rays a patch, at last H = D + F U gathered with all of them, B = E + rho H. Where emitters cover
/// much of the surface they are met by the rays instead. The same input and seed give the same bits for any
/// number of threads.
/// Cost: 30 to 50 ns of CPU a ray on merged polygons, about 1 us on a million rough triangles.
/// @param solving  method, tolerance and callbacks of the iteration on the stored rays; residuals are
/// relative to the emission, and an upper bound in the history where channels differ; no bounces
/// @throws SingularSystem; std::invalid_argument; Cancelled
GatheredSolution solve_gathered(const PatchMesh& mesh, const RayScene& occluders,
                                const PatchField& reflectance, const PatchField& emission,
                                const GatherOptions& options = {}, const SolveOptions& solving = {},
                                const Progress& progress = {});

}  // namespace luxel
