#include "transport/hierarchical/block_assembly.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "form_factors/shaft.h"
#include "stage_progress.h"
#include "transport/hierarchical/block_end.h"
#include "transport/hierarchical/block_errors.h"
#include "transport/hierarchical/block_rays.h"
#include "transport/hierarchical/corner_error.h"
#include "transport/hierarchical/near_occluders.h"
#include "transport/hierarchical/store_block.h"

namespace luxel {

namespace {

// Tasks in the fixed list: enough to keep many cores busy to the end.
constexpr std::size_t task_count = 4096;

// Rays: the first lot, what clusters get where these do not agree or an occluder is near, and the most that
// two single patches get.
constexpr int first_rays = 16;
constexpr int more_rays = 32;
constexpr int most_rays = 4096;

// What comes within so many of a flat end's radii stands on it.
constexpr double standing = 0.1;

// Long lists of occluders are looked through again only once the ends have shrunk to this share: bodies of
// many facets seldom let a block go for certain, and rays decide in the end.
constexpr std::size_t long_list = 8;
constexpr double shrunk_enough = 0.45;

class Assembly {
 public:
  Assembly(const PatchHierarchy& hierarchy, const HidingScene& scene, const Brightness& brightness,
           const AssemblyOptions& options)
      : hierarchy_(hierarchy),
        scene_(scene),
        brightness_(brightness),
        options_(options),
        coherent_(coherent_error * options.accuracy),
        near_(std::sqrt(shadow_error / coherent_)),
        hiding_(scene.rays != nullptr),
        rays_(hierarchy, hiding_ ? scene.rays->scene() : nullptr, options.seed) {}

  std::vector<BlockList> run(const Progress& progress) {
    std::vector<BlockList> lists(1);
    std::vector<Task> tasks{
        {hierarchy_.root, hierarchy_.root,
         hiding_ ? HidingCandidates{all_candidates(scene_.occluders)} : HidingCandidates()}};
    while (!tasks.empty() && tasks.size() < task_count) {
      std::vector<Task> next;
      for (const Task& task : tasks) run(task, lists[0], &next);
      tasks = std::move(next);
    }
    lists.resize(tasks.size() + 1);
    StageProgress stage(progress, "blocks", std::max<double>(1, static_cast<double>(tasks.size())));
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, tasks.size(), 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t k = range.begin(); k < range.end(); ++k) {
            if (stage.cancelled()) return;
            run(tasks[k], lists[k + 1], nullptr);
            lists[k + 1].shrink();
            stage.add(1);
          }
        },
        tbb::simple_partitioner());
    stage.finish();
    return lists;
  }

 private:
  struct Task {
    int r, s;
    HidingCandidates candidates;
  };

  void run(const Task& task, BlockList& list, std::vector<Task>* deferred) const {
    const BlockEnd r = block_end(hierarchy_, task.r, hiding_);
    if (task.r == task.s) {
      within(r, task.candidates, list, deferred);
    } else {
      between(r, block_end(hierarchy_, task.s, hiding_), task.candidates, list, deferred);
    }
  }

  // Pairs inside one cluster.
  void within(const BlockEnd& r, const HidingCandidates& candidates, BlockList& list,
              std::vector<Task>* deferred) const {
    if (r.bounds.planar) return;
    const PatchCluster& cluster = hierarchy_.clusters[r.cluster];
    for (int i = 0; i < cluster.child_count; ++i) {
      for (int j = 0; j <= i; ++j) {
        const Task task{cluster.children[i], cluster.children[j], candidates};
        deferred ? deferred->push_back(task) : run(task, list, nullptr);
      }
    }
  }

  void divide(const BlockEnd& r, const BlockEnd& s, const HidingCandidates& candidates, BlockList& list,
              std::vector<Task>* deferred) const {
    divide_end(r, s, !r.single && (s.single || r.bounds.radius >= s.bounds.radius), candidates, list,
               deferred);
  }

  // Divides the one end that is said to be too large, or the larger of both; false if that is a single patch.
  // Horizons and near occluders change the kernel across an end alike for all parts of the other, whose
  // errors add up.
  bool divide_one(const BlockEnd& r, const BlockEnd& s, bool large_r, bool large_s,
                  const HidingCandidates& candidates, BlockList& list, std::vector<Task>* deferred) const {
    const bool first = large_r && !r.single, second = large_s && !s.single;
    if (!first && !second) return false;
    divide_end(r, s, first && (!second || r.bounds.radius >= s.bounds.radius), candidates, list, deferred);
    return true;
  }

  void divide_end(const BlockEnd& r, const BlockEnd& s, bool first, const HidingCandidates& candidates,
                  BlockList& list, std::vector<Task>* deferred) const {
    const PatchCluster& cluster = hierarchy_.clusters[first ? r.cluster : s.cluster];
    for (int k = 0; k < cluster.child_count; ++k) {
      const int child = cluster.children[k];
      if (deferred) {
        deferred->push_back(first ? Task{child, s.cluster, candidates} : Task{r.cluster, child, candidates});
      } else if (first) {
        between(block_end(hierarchy_, child, hiding_), s, candidates, list, nullptr);
      } else {
        between(r, block_end(hierarchy_, child, hiding_), candidates, list, nullptr);
      }
    }
  }

  // Divides an end that has an occluder near, unless all that can be asked agrees; else draws the rays that
  // tell how much is hidden.
  bool divided_by_shadows(const BlockEnd& r, const BlockEnd& s, double allowed,
                          const HidingCandidates& candidates, RayCount& rays, BlockList& list,
                          std::vector<Task>* deferred) const {
    const bool counts = coherence * mixed_error > allowed;
    const bool near_r = counts && occluder_near(scene_.occluders, candidates, r, near_);
    const bool near_s = counts && occluder_near(scene_.occluders, candidates, s, near_);
    bool large_r = near_r, large_s = near_s;
    if ((near_r || near_s) && rays.unanimous()) {
      // a few rays that agree are no proof where much is half hidden all around
      rays_.cast_between_corners(r, s, rays);
      if (rays.borne_out()) rays_.cast(r, s, more_rays, rays);
      if (rays.unanimous() && rays.borne_out()) {
        const auto stands = [&](const BlockEnd& end) {
          return rays.visible > 0 && occluder_stands_on(scene_.occluders, candidates, end, standing);
        };
        large_r = near_r && !r.single && stands(r);
        large_s = near_s && !s.single && stands(s);
      }
    }
    const bool dividing = (large_r && !r.single) || (large_s && !s.single);
    if (!dividing && !rays.unanimous()) rays_.cast(r, s, more_rays, rays);
    list.rays += rays.all + rays.corners;
    return divide_one(r, s, large_r, large_s, candidates, list, deferred);
  }

  // Error of the kernel across an end that the other's horizon crosses.
  static double kink(const BlockEnd& end, const BlockEnd& other, const std::array<double, 16>& at_nodes,
                     double share) {
    return end.bounds.planar ? corner_error(end, other, at_nodes) : kink_error * share;
  }

  void between(const BlockEnd& r, const BlockEnd& s, const HidingCandidates& inherited, BlockList& list,
               std::vector<Task>* deferred) const {
    const Span over_r = heights_over(r.bounds, s.bounds);
    if (over_r.high <= plane_tolerance) return;
    const Span over_s = heights_over(s.bounds, r.bounds);
    if (over_s.high <= plane_tolerance) return;
    const double reach = r.bounds.radius + s.bounds.radius;
    HidingCandidates found;
    const bool look = !inherited.empty() &&
                      (inherited.list.size() <= long_list || reach <= shrunk_enough * inherited.reach);
    if (look) {
      ShaftCandidates in_shaft = candidates_in_shaft(r.shaft, s.shaft, scene_.occluders, inherited.list);
      if (in_shaft.hidden) {
        ++list.hidden;
        return;
      }
      found = {std::move(in_shaft.list), reach};
    }
    const HidingCandidates& candidates = look ? found : inherited;
    const bool single = r.single && s.single;
    if (!single && !(r.usable && s.usable)) {
      divide(r, s, candidates, list, deferred);
      return;
    }

    const BlockKernel kernel = block_kernel(r, s);
    const double apart = (r.bounds.centre - s.bounds.centre).norm();
    const double ratio = reach / std::max(apart, 1e-300);
    const double bright_r = brightness_(hierarchy_, r.cluster), bright_s = brightness_(hierarchy_, s.cluster);
    double share = kernel.largest;  // of form factor per area of the other end
    if (ratio > touching_ratio) {
      share =
          std::max(share, std::min(4 / (std::numbers::pi * apart * apart), 0.25 / std::min(r.area, s.area)));
    }
    const bool straddling_r = over_s.low < -straddling_depth, straddling_s = over_r.low < -straddling_depth;
    double error = ratio > touching_ratio ? touching_error : interpolation_error * ratio * ratio;
    if (straddling_r || straddling_s) {
      // the nodes may all be behind the horizon where a corner is not
      share = std::max(share, over_r.high * over_s.high / (std::numbers::pi * std::pow(apart, 4)));
      error = std::max(error, straddling_error);
    }
    error += r.roughness + s.roughness;
    const double weight =
        std::max(std::min(share * s.area, 1.0) * bright_s, std::min(share * r.area, 1.0) * bright_r);
    const double allowed = options_.block_error / std::max(weight, 1e-300);
    if (!single && error > allowed) {
      divide(r, s, candidates, list, deferred);
      return;
    }
    const double nearby = std::numbers::pi * apart * apart;
    const bool kinked_r = straddling_r && !r.single &&
                          kink(r, s, kernel.values, share) * std::min(nearby, plane_area(hierarchy_, s)) >
                              kink_share * coherent_;
    const bool kinked_s =
        straddling_s && !s.single &&
        kink(s, r, kernel.from_other_end(), share) * std::min(nearby, plane_area(hierarchy_, r)) >
            kink_share * coherent_;
    if (divide_one(r, s, kinked_r, kinked_s, candidates, list, deferred)) return;
    const double smooth = coherent_ / rough_error;
    if (divide_one(r, s, r.roughness > smooth, s.roughness > smooth, candidates, list, deferred)) return;
    const BlockTolerance tolerance{options_.block_error, bright_r, bright_s};
    if (single && (ratio > near_ratio || straddling_r || straddling_s)) {
      store_near(r, s, candidates.empty(), allowed, tolerance, list);
      return;
    }
    RayCount rays;
    if (!candidates.empty()) {
      if (!single && unknown_error > allowed) {
        divide(r, s, candidates, list, deferred);
        return;
      }
      rays_.cast(r, s, first_rays, rays);
      if (single) {
        while (rays.error() > allowed && rays.drawn < most_rays) rays_.cast(r, s, 2 * rays.drawn, rays);
        list.rays += rays.all;
      } else if ((rays.unanimous() ? agreed_error : mixed_error) > allowed) {
        list.rays += rays.all;
        divide(r, s, candidates, list, deferred);
        return;
      } else if (divided_by_shadows(r, s, allowed, candidates, rays, list, deferred)) {
        return;
      }
      if (rays.all > 0 && rays.visible == 0) {
        ++list.hidden;
        return;
      }
    } else {
      ++list.unhidden;
    }
    store_block(r, s, kernel, rays, tolerance, list);
  }

  // Single patches that are too close, or too steep, for the kernel between their nodes.
  void store_near(const BlockEnd& r, const BlockEnd& s, bool unhidden, double allowed,
                  const BlockTolerance& tolerance, BlockList& list) const {
    int rays = 0;
    const double visible = unhidden ? 1 : rays_.visible_share(r, s, allowed, rays);
    list.rays += rays;
    if (unhidden) ++list.unhidden;
    if (visible > 0) {
      store_near_block(r, s, visible, tolerance, list);
    } else {
      ++list.hidden;
    }
  }

  const PatchHierarchy& hierarchy_;
  const HidingScene& scene_;
  const Brightness& brightness_;
  const AssemblyOptions& options_;
  double coherent_;  // what errors may add up to, of the irradiance
  double near_;      // radii within which an occluder is near
  bool hiding_;
  BlockRays rays_;
};

}  // namespace

std::vector<BlockList> assemble_blocks(const PatchHierarchy& hierarchy, const HidingScene& scene,
                                       const Brightness& brightness, const AssemblyOptions& options,
                                       const Progress& progress) {
  if (hierarchy.order.empty()) return {};
  return Assembly(hierarchy, scene, brightness, options).run(progress);
}

}  // namespace luxel
