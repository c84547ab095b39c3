#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "luxel/dense_operator.h"
#include "luxel/enclosures.h"
#include "luxel/form_factors.h"
#include "luxel/gather_operator.h"
#include "luxel/hierarchical_operator.h"
#include "luxel/operator_error.h"
#include "luxel/patch_mesh.h"
#include "luxel/progress.h"
#include "luxel/solve.h"

namespace luxel {

/// How light is exchanged.
enum class OperatorKind {
  automatic,    ///< see choose_operator()
  dense,        ///< every pair of patches
  gather,       ///< rays from each patch
  hierarchical  ///< pairs of clusters of patches
};

/// "auto", "dense", "gather" or "hierarchical".
std::string_view name(OperatorKind kind);
std::optional<OperatorKind> operator_from_name(std::string_view name);

/// What may be left out. Each can be switched off alone; the result is the same to the accuracy asked for.
struct Savings {
  bool dark_enclosures = true;      ///< enclosures without emission are left out, their light is exactly 0
  bool separate_enclosures = true;  ///< each enclosure is a system of its own, solved one after the other
  bool idle_occluders = true;       ///< polygons that cannot hide anything are dropped; none left: no ray
  bool channels = true;   ///< channels without emission are 0, those proportional to another are not solved
  bool method = true;     ///< the cheapest of conjugate gradients, bounces and Cholesky; else the first
  bool precision = true;  ///< entries are stored in float32 where the accuracy allows; else in float64

  /// Every saving switched off.
  static Savings none() { return {false, false, false, false, false, false}; }
};

struct PlanOptions {
  Savings savings;
  FormFactorOptions form_factors;  ///< precision is the plan's to choose
  SolveOptions solve;              ///< on_iteration: numbers start from 0 with each system (see run_plan())
  /// All lit enclosures in one system, for those who want to see whole fields bounce by bounce.
  bool together = false;
  /// One system of all patches, for an operator that is kept or was loaded.
  bool everything = false;
  /// Estimate the operator's error besides, at most an eighth more rays or time; not with counted bounces.
  bool error_bar = false;
  /// Of a gather that progress cancels after its iteration, give the light of the rays at hand; see
  /// GatherReport.
  bool keep_partial = false;
};

/// One thing that is left out, in words for a report.
struct LeftOut {
  std::string what;
  std::string why;
  std::string saved;  ///< in numbers that were counted, not guessed
};

/// Which channels of a system are solved, and how the others follow.
struct ChannelPlan {
  std::vector<int> solved;      ///< channels with a right-hand side of their own
  std::vector<int> source;      ///< for each channel its place in `solved`; -1: exactly 0
  std::vector<double> factors;  ///< B of the channel = factor * B of its source
};

/// Channels without emission are 0; a channel whose reflectance equals that of an earlier one on every patch,
/// bit for bit, and whose emission is a multiple of it to 4 roundings, follows from it. Channels that nothing
/// absorbs (`lossless`, one flag each) are never 0 by themselves: their system is singular and has to be
/// refused.
ChannelPlan plan_channels(const PatchField& reflectance, const PatchField& emission,
                          const std::vector<char>& lossless);

/// Patches that are assembled and solved as one system.
struct SystemPlan {
  std::vector<int> patches;  ///< indices into the mesh, rising
  bool closed = false;       ///< all its enclosures are
  int polygons = 0;          ///< of the occluders around it
  int hiding_polygons = 0;   ///< of them those that can hide one patch from another; 0: no ray is cast
  ChannelPlan channels;
  Precision precision = Precision::float32;
  Method method = Method::automatic;  ///< what is asked of solve()
};

/// What a scene needs, decided before any of it is computed. On patches in no system B = E and H = 0: they
/// are dark, or see nobody.
struct Plan {
  int patches = 0;
  std::vector<SystemPlan> systems;
  bool keep_idle_occluders = false;
  std::vector<LeftOut> left_out;
};

/// Decides by looking at geometry, finishes and enclosures only. Cost: linear in patches, and polygons times
/// vertices at worst with early exits.
Plan make_plan(const PatchMesh& mesh, const Enclosures& enclosures, const PlanOptions& options = {});

/// The enclosures of a mesh: one closed one, without a ray or anything to trace it against, where the surface
/// is proven convex (savings.idle_occluders); else found by find_enclosures().
Enclosures planned_enclosures(const PatchMesh& mesh, const PlanOptions& options = {},
                              const Progress& progress = {});

/// Whether the patches are the inside of one convex surface without holes, T-vertices or steps above 1e-10 of
/// its size: every patch then sees fronts of others in every direction. False where that is not proven.
bool convex_inside(const PatchMesh& mesh);

/// Polygons of the occluders that have corners of patches on both sides; the others cannot hide anything.
int hiding_polygons(const PatchMesh& mesh);

/// The mesh of some patches (rising indices), with the occluders that can matter between them: those around
/// them in a closed enclosure, which lets no other be seen; those that reach into their bounding box else.
/// The tables of names and finishes are kept whole.
/// @throws std::invalid_argument for an index out of range
PatchMesh sub_mesh(const PatchMesh& mesh, const std::vector<int>& patches, bool closed);

/// The entries' precision: float64 where there are at most 4,000 patches, since it costs nothing there, and
/// where the rounding of float32 (up to 1e-7 of a row) would be felt; else float32.
Precision storage_precision(int patches, double accuracy);

/// CPU time and memory, from the cost model of docs/plan.md: meant to be right within a factor of two on a
/// machine like the one that it was measured on.
struct Cost {
  double cpu_seconds = 0;
  double bytes = 0;  ///< at the peak, the program itself included
};

/// Memory that following the plan will take at its peak, about [bytes].
double planned_bytes(const Plan& plan);

/// What following the plan will cost, enclosures and mesh included. Draws at most 2,000 pairs of patches to
/// see how many hide each other; the same figures every time.
Cost estimated_cost(const Plan& plan, const PatchMesh& mesh, const Enclosures& enclosures,
                    const PlanOptions& options = {});

/// What following a plan for gathering will cost: accuracy and seed as of form_factors. Memory is that of the
/// program, the mesh, the fields and the rays that are kept.
Cost estimated_gather_cost(const PatchMesh& mesh, const PlanOptions& options = {});

/// The best accuracy that gather and hierarchical can be asked for: below it, what patches' edges are moved
/// by in the one, and the blocks' rules in the other, would count.
inline constexpr double finest_sampled = 1e-4;

/// What an operator would cost.
struct OperatorEstimate {
  OperatorKind kind = OperatorKind::dense;
  Cost cost;
  bool fits = true;  ///< into the memory
};

/// The operator for a scene, with what each would cost.
struct OperatorChoice {
  OperatorKind kind = OperatorKind::dense;
  std::vector<OperatorEstimate> estimates;
};

/// Chooses for the scene, accuracy, channels and memory at hand: dense where it takes a few seconds, or not
/// much longer than the others, since it is symmetric, serves every light and has entries; else the fastest
/// that fits. Where none fits, the smallest. Looks at geometry and finishes only, without a ray; at most a
/// tenth of a second up to 10,000 patches.
/// @param most_bytes  memory that may be taken
OperatorChoice choose_operator(const PatchMesh& mesh, const PlanOptions& options, double most_bytes);

/// The same of the hierarchical operator.
Cost estimated_hierarchical_cost(const PatchMesh& mesh, const PlanOptions& options = {});

enum class PlanStage { assembling, solving, measuring, done };

/// Who follows a plan from outside; both may be empty.
struct PlanListener {
  Progress progress;
  std::function<void(PlanStage)> on_stage;  ///< at the start of each; the library reads no clock
};

/// The light of a scene, found system by system, and how.
struct PlannedSolution {
  /// On all patches. Of the systems' reports: the most iterations, the largest bound, the first trouble;
  /// relative residuals together as of one system. The history goes by iteration number, over all systems.
  RadiositySolution solution;
  Energy energy;
  std::vector<double> row_sums;    ///< N: raw, before any correction; NaN where nothing was assembled
  std::vector<double> sky_shares;  ///< N: of the systems that are open; NaN else
  ClosureReport closure;           ///< worst over systems
  FormFactorReport form_factors;   ///< sums over systems
  std::size_t operator_bytes = 0;  ///< held at once, at most
  std::int64_t rays = 0;           ///< cast for the operator
  /// Of A_i F_ij = A_j F_ji: 0 where each pair is stored once; of a gather between 64 parts of equal area,
  /// the Frobenius norm of what is not symmetric relative to the whole.
  double reciprocity_error = 0;
  std::optional<OperatorError> operator_error;  ///< where PlanOptions::error_bar asks for it
};

/// Follows a plan: assembles, closes, solves and forgets each system in turn. options.solve.on_iteration is
/// told of each system's iterations; their radiosity is that of the whole mesh where the plan has one system,
/// else null; where it returns false, the systems to come are left at B = E.
/// @throws SingularSystem; Cancelled; std::invalid_argument as solve() and form_factors() do
PlannedSolution run_plan(const Plan& plan, const PatchMesh& mesh, const Enclosures& enclosures,
                         const PlanOptions& options = {}, const PlanListener& listener = {});

/// The same with an operator of all patches at hand, for plans made for `everything`.
/// @throws std::invalid_argument if the plan is not one system of all patches
PlannedSolution run_plan(const Plan& plan, const TransportOperator& transport, const PatchMesh& mesh,
                         const PlanOptions& options = {}, const PlanListener& listener = {});

/// What run_gathered() gives: its plan is made on the way.
struct GatheredRun {
  PlannedSolution light;  ///< `form_factors` and `closure` are empty; row_sums of all rays
  Enclosures enclosures;  ///< as the rays found them; backs count as open
  GatherReport gather;
  std::vector<LeftOut> left_out;
};

/// The light of a scene by gathering, all patches in one system but those of closed enclosures without
/// emission that the surfaces prove (savings.dark_enclosures): B = H = 0 there, row_sums are not numbers.
/// Accuracy and seed as of form_factors, method (neumann, gmres or automatic) and tolerance as of `solve`.
/// Iterations are told with the radiosity of the whole mesh.
/// @throws SingularSystem; Cancelled; std::invalid_argument as solve_gathered() does
GatheredRun run_gathered(const PatchMesh& mesh, const PlanOptions& options = {},
                         const PlanListener& listener = {});

/// What run_hierarchical() gives.
struct HierarchicalRun {
  PlannedSolution light;  ///< `form_factors` is empty; row_sums after rows were scaled
  Enclosures enclosures;  ///< by few rays from each patch where the surfaces prove nothing
  HierarchicalReport hierarchical;
  std::vector<LeftOut> left_out;
};

/// The light of a scene by clusters, all patches in one system but those that run_gathered() leaves out too:
/// accuracy and seed as of form_factors, the rest as of `solve`.
/// @throws SingularSystem; Cancelled; std::invalid_argument as solve_hierarchical() does
HierarchicalRun run_hierarchical(const PatchMesh& mesh, const PlanOptions& options = {},
                                 const PlanListener& listener = {});

}  // namespace luxel
