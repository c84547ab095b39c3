#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "luxel/dense_operator.h"
#include "luxel/enclosures.h"
#include "luxel/patch_mesh.h"
#include "luxel/progress.h"
#include "luxel/solve.h"
#include "luxel/transport_operator.h"
#include "luxel/vector.h"

namespace luxel {

/// How light is exchanged between clusters of patches. The door for most users is solve_hierarchical().
struct HierarchicalOptions {
  double accuracy = 0.01;  ///< asked area-weighted relative RMS error of the irradiance, in [1e-4, 0.3]
  std::uint64_t seed = 0;  ///< of the visibility rays: another seed, another sample of the same error
};

/// What the assembly did.
struct HierarchicalReport {
  std::int64_t clusters = 0;  ///< of the tree, single patches left out
  std::int64_t unknowns = 0;  ///< of the coarse system; see HierarchicalOperator::coarse
  std::int64_t blocks = 0;    ///< pairs of clusters that exchange light, each stored once
  std::int64_t entries = 0;   ///< pairs of single patches, each stored once
  std::int64_t unhidden = 0;  ///< of both, proven to have nothing between: no ray was cast
  std::int64_t hidden = 0;    ///< pairs of clusters or patches that exchange nothing, proven or by rays
  std::int64_t rays = 0;      ///< cast to find what is hidden
  int occluders = 0;          ///< convex polygons that can hide anything; 0: no ray was cast
  std::size_t bytes = 0;      ///< of the operator
  ClosureReport closure;      ///< row sums before and after they were scaled; largest_correction is a bound
};

/// F by blocks between clusters of patches: the kernel at a few nodes of either cluster, light interpolated
/// over the clusters (an H^2 matrix), near patches one by one. Symmetric: A_i F_ij = A_j F_ji exactly, by
/// construction. Where the enclosures are closed, rows are scaled to sum to 1, symmetrically; see close_rows.
/// Sources: Hanrahan, Salzman and Aupperle 1991; Smits, Arvo and Greenberg 1994; Hackbusch and Boerm 2002.
class HierarchicalOperator : public TransportOperator {
 public:
  struct Impl;
  explicit HierarchicalOperator(std::unique_ptr<Impl> impl);
  ~HierarchicalOperator() override;

  int size() const override;
  void apply(const double* x, double* y, int columns) const override;
  std::span<const double> row_sums() const override;
  std::span<const double> areas() const override;
  bool symmetric() const override { return true; }
  std::size_t bytes() const override;
  std::string_view kind() const override { return "hierarchical"; }

  const HierarchicalReport& report() const;

  /// The same operator between the nodes of the smallest clusters that any block reaches, far fewer than
  /// patches: F = expand . coarse . restrict. A node's area is its share of its cluster's.
  const TransportOperator& coarse() const;
  /// Values at the coarse nodes, n x m, from patch values, N x m: area-weighted means around each node.
  PatchField restrict(const PatchField& patches) const;
  /// Values on the patches, N x m, from values at the coarse nodes, n x m: interpolated.
  PatchField expand(const PatchField& nodes) const;

 private:
  std::unique_ptr<Impl> impl_;
};

/// The operator, with the most detail where the light of this emission goes: estimated from a coarse solve.
/// It serves any light; others, with small lamps elsewhere, less accurately.
/// Cost: about N^0.5 to N at fixed accuracy: far pairs stop at clusters whose size the accuracy sets.
/// @param enclosures  of the mesh; closed ones have their rows scaled to 1
/// @param reflectance, emission  N x m, as for solve()
/// @throws std::invalid_argument for shapes, ranges, or enclosures of another mesh; Cancelled
std::unique_ptr<HierarchicalOperator> hierarchical_operator(
    const PatchMesh& mesh, const Enclosures& enclosures, const PatchField& reflectance,
    const PatchField& emission, const HierarchicalOptions& options = {}, const Progress& progress = {});

/// The operator for light of unknown origin: every pair as if all patches were equally bright.
std::unique_ptr<HierarchicalOperator> hierarchical_operator(const PatchMesh& mesh,
                                                            const Enclosures& enclosures,
                                                            const HierarchicalOptions& options = {},
                                                            const Progress& progress = {});

/// Radiosity and irradiance, with the operator that they belong to (its report says how it was made).
struct HierarchicalSolution {
  RadiositySolution light;
  std::unique_ptr<HierarchicalOperator> transport;
};

/// Solves B = E + rho F B with a hierarchical F, on its coarse nodes where reflectance and emission are equal
/// all over each finish, on the patches otherwise; the irradiance is expanded to the patches once, at the
/// end. The same input and seed give the same bits for any number of threads.
/// @param solving  method, tolerance, bounces and callbacks of the iteration; its tolerance is raised to a
/// hundredth of the accuracy, since less is lost in the blocks; callbacks get no radiosity where nodes are
/// iterated on
/// @throws SingularSystem; std::invalid_argument; Cancelled
HierarchicalSolution solve_hierarchical(const PatchMesh& mesh, const Enclosures& enclosures,
                                        const PatchField& reflectance, const PatchField& emission,
                                        const HierarchicalOptions& options = {},
                                        const SolveOptions& solving = {}, const Progress& progress = {});

}  // namespace luxel
