#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "form_factors/block_sights.h"
#include "form_factors/cluster_tree.h"
#include "form_factors/group_exchange.h"
#include "form_factors/hidden_pair.h"
#include "form_factors/occluder_scene.h"
#include "form_factors/occluder_set.h"
#include "form_factors/ray_visibility.h"
#include "form_factors/shaft.h"
#include "luxel/form_factors.h"

namespace luxel {

/// What is the same for all blocks of a scene.
struct BlockedScene {
  const PatchMesh& mesh;
  const ClusterTree& tree;
  const OccluderSet& set;
  const FormFactorOptions& options;
  std::vector<ShaftEnd> ends;         ///< of each cluster
  std::vector<int> leaf;              ///< of each patch its cluster
  GroupExchange groups;               ///< where their factors are held to the accuracy too, else empty
  std::optional<OccluderScene> rays;  ///< not where everything is clipped
  std::optional<SightSorter> sorter;

  /// @param unhidden  exchange areas with nothing between
  BlockedScene(const PatchMesh& patch_mesh, const ClusterTree& cluster_tree, const OccluderSet& occluders,
               const FormFactorOptions& factor_options, const ExchangeMatrix& unhidden);
};

/// One block of the matrix, a pair of clusters, with the occluders that may matter in it.
struct Block {
  int a = 0, b = 0;
  std::vector<Candidate> candidates;
};

/// What was found of a block; summed in the order of the blocks.
struct VisibilityTally {
  std::int64_t hidden = 0, partial = 0, exact = 0, sampled = 0, rays = 0;
  double squared_error = 0;  ///< sum of e^2 (1 / A_i + 1 / A_j)

  void operator+=(const VisibilityTally& other);
};

/// Sets the exchange areas of all pairs of two clusters to 0.
void hide_block(const ClusterTree& tree, int a, int b, ExchangeMatrix& exchange_areas,
                VisibilityTally& tally);

/// Takes away what is hidden in blocks, one after the other. One per thread: it keeps its working memory.
class BlockVisibility {
 public:
  BlockVisibility(const BlockedScene& scene, ExchangeMatrix& exchange_areas);

  VisibilityTally operator()(const Block& block);

 private:
  void descend(int a, int b, const std::vector<Candidate>& candidates);
  bool rays_decide(const Cluster& a, const Cluster& b, std::size_t candidates) const;
  bool sample_loose(int a, int b, const std::vector<Candidate>& candidates);
  void sort_by_rays(int a, int b, const std::vector<Candidate>& candidates);
  void sample_or_clip(int s, int t, double exchange, double for_rays,
                      const std::vector<Candidate>& candidates);
  void look_between(int s, int t, const std::vector<Candidate>& candidates);
  void pair(int s, int t, const std::vector<Candidate>& candidates);
  void sample_all();
  void store(int s, int t, double visible, double error);
  double unhidden(int s, int t) const;
  // What the visible part of a pair may be off, by clipping and by rays; working units.
  struct Allowed {
    double clip, rays;
  };
  Allowed allowed(int s, int t, double exchange) const;

  const BlockedScene& scene_;
  const ClusterTree& tree_;
  ExchangeMatrix& exchange_;
  HiddenPair clip_;
  VisibilityTally tally_;
  std::vector<RayPair> sampled_, loose_;
};

}  // namespace luxel
