#pragma once

#include <cstdint>
#include <vector>

#include "form_factors/cluster_tree.h"
#include "form_factors/hidden_kernel.h"
#include "form_factors/hidden_quadrature.h"
#include "form_factors/occluder_set.h"
#include "form_factors/shaft.h"
#include "luxel/patch_mesh.h"

namespace luxel {

/// What occluders take from the exchange area of one pair, in working units.
struct HiddenPart {
  bool all = false;  ///< everything is hidden, proven
  double value = 0;
  double error = 0;  ///< estimate
};

/// A patch that reaches through a face's plane by less than this touches the plane, in working units.
double touching_depth(const WorkPatch& patch);

/// Visibility of single pairs by clipping: exact in the inner patch, by quadrature over the outer one, which
/// is cut where the view changes its shape. One per thread: it keeps its working memory.
class HiddenPair {
 public:
  HiddenPair(const PatchMesh& mesh, const ClusterTree& tree, const OccluderSet& set);

  /// @param s, t       patches in tree order
  /// @param unhidden   exchange area of the pair with nothing between, working units
  /// @param tolerance  of the result, working units
  HiddenPart operator()(int s, int t, const std::vector<Candidate>& candidates, double unhidden,
                        double tolerance);

 private:
  struct Ends {
    const WorkPatch* outer;
    const WorkPatch* inner;
    Polygon cell;    ///< of the outer patch what sees the inner one's plane from the front
    Polygon target;  ///< of the inner patch likewise
  };
  enum class Cast { misses, shadow, everything };

  Ends ends(int s, int t, const std::vector<Candidate>& candidates) const;
  bool own(const Occluder& occluder, const Ends& ends) const;
  std::vector<Polygon> cells_by_side(const Ends& ends, const std::vector<Candidate>& candidates) const;
  Cast cast_all(const Polygon& cell, const Ends& ends, const std::vector<Candidate>& candidates);
  Cast cast(const Polygon& cell, const Ends& ends, const Occluder& occluder);
  Cast cast_face(const Polygon& cell, const Ends& ends, const OccluderFace& face);
  Cast cast_body(const Polygon& cell, const Ends& ends, const Occluder& body);
  Cast cast_round(const Polygon& cell, const Occluder& body);
  Span volumes(const ShadowEdge& edge) const;
  Cast keep_relevant();
  // Whether nothing of the target is in sight from any point of a rule over the cell.
  bool covered(const Polygon& cell, const Ends& ends, const std::vector<Candidate>& candidates);
  bool add_cut(const Polygon& cell, const Polygon& target, const Plane& behind);

  const PatchMesh& mesh_;
  const ClusterTree& tree_;
  const OccluderSet& set_;
  Shadows shadows_;
  HiddenWorkspace workspace_;
  std::vector<int> round_body_;  // of each polygon the round body that it is part of, or -1
  std::vector<ShadowEdge> edges_, cuts_;
  std::vector<Span> heights_;
  std::vector<Vec3> lines_, sights_;
};

}  // namespace luxel
