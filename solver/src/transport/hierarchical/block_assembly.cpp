#include "transport/hierarchical/block_assembly.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "form_factors/pair.h"
#include "form_factors/shaft.h"
#include "stage_progress.h"
#include "transport/hierarchical/block_end.h"
#include "transport/hierarchical/block_rays.h"

namespace luxel {

namespace {

// Tasks in the fixed list: enough to keep many cores busy to the end.
constexpr std::size_t task_count = 4096;

// Bilinear interpolation of the kernel between ends of radii r and s at distance d errs by about this times
// ((r + s) / d)^2 of it.
constexpr double interpolation_error = 0.5;

// Ends nearer than this, (r + s) / d, are too close for the nodes to tell the kernel; what they exchange is
// then uncertain by this share of it.
constexpr double touching_ratio = 0.8;
constexpr double touching_error = 0.25;

// Nearer single patches, and those that straddle, get an exact kernel.
constexpr double near_ratio = 0.5;

// An end partly behind the other's horizon: the kernel has a kink.
constexpr double straddling_error = 0.1;
constexpr double straddling_depth = 1e-7;

// What a block with some occluder between may err by before rays are cast, after they agreed, and where they
// do not, beside their own standard error.
constexpr double unknown_error = 0.04;
constexpr double agreed_error = 0.04;
constexpr double mixed_error = 0.12;

// Horizons and near occluders change the kernel across an end alike for all parts of the other's
// surroundings, whose errors then add up, to this many times the accuracy at most.
constexpr double coherent_error = 5;

// The bilinear interpolation across a horizon errs by this share of what all of the plane behind it sends.
constexpr double kink_error = 0.5;

// The shadow of an occluder `near` radii away changes across an end by 1 / near^2 of this.
constexpr double shadow_error = 0.125;

// So many blocks, about, share one shadow's error: smaller ones may be mixed.
constexpr double coherence = 14;

// Rays: the first lot, and the most that two single patches get.
constexpr int first_rays = 16;
constexpr int most_rays = 256;

// Rays that must agree where an occluder is near.
constexpr int agreeing_rays = 256;

// A side is taken for constant where that changes the irradiance by less than this share of the block's
// error.
constexpr double collapse_share = 0.3;

// An exact pair of patches may err by this share of the block's error.
constexpr double near_share = 0.1;

// Long lists of occluders are looked through again only once the ends have shrunk to this share: bodies of
// many facets seldom let a block go for certain, and rays decide in the end.
constexpr std::size_t long_list = 8;
constexpr double shrunk_enough = 0.6;

// What may stand between two ends, found when their radii summed up to `reach`.
struct Candidates {
  std::vector<Candidate> list;
  double reach = std::numeric_limits<double>::infinity();

  bool empty() const { return list.empty(); }
};

// From a point to a convex face.
double distance(const OccluderFace& face, const Vec3& x) {
  const double height = face.plane.distance(x);
  const Vec3 foot = x - height * face.plane.normal;
  double aside = 0;  // squared, from the foot to the outline
  for (int k = 0; k < face.outline.count; ++k) {
    if (face.sides[k].distance(foot) >= 0) continue;
    const Vec3 along = face.outline.next(k) - face.outline[k];
    const double at = std::clamp((foot - face.outline[k]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const double squared = (foot - face.outline[k] - at * along).squaredNorm();
    aside = aside == 0 ? squared : std::min(aside, squared);
  }
  return std::sqrt(height * height + aside);
}

// Of what the kernel would let through.
double visible_share(const BlockKernel& kernel, const RayCount& rays) {
  if (rays.unanimous()) return rays.share();
  double all = 0, visible = 0;
  for (int k = 0; k < 16; ++k) {
    all += kernel.values[k];
    visible += kernel.values[k] * rays.share(k);
  }
  return all > 0 ? visible / all : rays.share();
}

class Assembly {
 public:
  Assembly(const PatchHierarchy& hierarchy, const HidingScene& scene, const Brightness& brightness,
           const AssemblyOptions& options)
      : hierarchy_(hierarchy),
        scene_(scene),
        brightness_(brightness),
        options_(options),
        kink_(coherent_error * options.accuracy / kink_error),
        near_(std::sqrt(shadow_error / (coherent_error * options.accuracy))),
        hiding_(scene.rays != nullptr),
        rays_(hierarchy, hiding_ ? scene.rays->scene() : nullptr, options.seed) {}

  std::vector<BlockList> run(const Progress& progress) {
    std::vector<BlockList> lists(1);
    std::vector<Task> tasks{{hierarchy_.root, hierarchy_.root,
                             hiding_ ? Candidates{all_candidates(scene_.occluders)} : Candidates()}};
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
    Candidates candidates;
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
  void within(const BlockEnd& r, const Candidates& candidates, BlockList& list,
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

  void divide(const BlockEnd& r, const BlockEnd& s, const Candidates& candidates, BlockList& list,
              std::vector<Task>* deferred) const {
    divide_end(r, s, !r.single && (s.single || r.bounds.radius >= s.bounds.radius), candidates, list,
               deferred);
  }

  // Of all that lies in one plane with the end and sends as it does.
  double plane_area(const BlockEnd& end) const {
    const int position =
        end.single ? end.cluster - hierarchy_.cluster_count() : hierarchy_.clusters[end.cluster].begin;
    return end.bounds.planar ? hierarchy_.groups[hierarchy_.group[position]].area : end.area;
  }

  // Whether a face that may stand between is so near that its shadow changes across the end.
  bool occluder_near(const BlockEnd& end, const Candidates& candidates) const {
    const double near_enough = near_ * end.bounds.radius;
    for (const Candidate& candidate : candidates.list) {
      const Occluder& occluder = scene_.occluders.occluders[candidate.occluder];
      if ((occluder.centre - end.bounds.centre).norm() > near_enough + occluder.radius) continue;
      for (int k = 0; k < occluder.face_count(); ++k) {
        if (!((candidate.from_a | candidate.from_b) >> k & 1)) continue;
        if (distance(scene_.occluders.faces[occluder.begin + k], end.bounds.centre) < near_enough) {
          return true;
        }
      }
    }
    return false;
  }

  // Divides the one end that is said to be too large, or the larger of both; false if that is a single patch.
  // Horizons and near occluders change the kernel across an end alike for all parts of the other, whose
  // errors add up.
  bool divide_one(const BlockEnd& r, const BlockEnd& s, bool large_r, bool large_s,
                  const Candidates& candidates, BlockList& list, std::vector<Task>* deferred) const {
    const bool first = large_r && !r.single, second = large_s && !s.single;
    if (!first && !second) return false;
    divide_end(r, s, first && (!second || r.bounds.radius >= s.bounds.radius), candidates, list, deferred);
    return true;
  }

  void divide_end(const BlockEnd& r, const BlockEnd& s, bool first, const Candidates& candidates,
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

  void between(const BlockEnd& r, const BlockEnd& s, const Candidates& inherited, BlockList& list,
               std::vector<Task>* deferred) const {
    const Span over_r = heights_over(r.bounds, s.bounds);
    if (over_r.high <= plane_tolerance) return;
    const Span over_s = heights_over(s.bounds, r.bounds);
    if (over_s.high <= plane_tolerance) return;
    const double reach = r.bounds.radius + s.bounds.radius;
    Candidates found;
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
    const Candidates& candidates = look ? found : inherited;
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
    const bool kinked_r = straddling_r && share * std::min(nearby, plane_area(s)) * bright_s > kink_;
    const bool kinked_s = straddling_s && share * std::min(nearby, plane_area(r)) * bright_r > kink_;
    if (divide_one(r, s, kinked_r, kinked_s, candidates, list, deferred)) return;
    RayCount rays;
    if (!candidates.empty()) {
      if (!single && unknown_error > allowed) {
        divide(r, s, candidates, list, deferred);
        return;
      }
      rays_.cast(r, s, first_rays, rays);
      if (single) {
        while (rays.error() > allowed && rays.drawn < most_rays) rays_.cast(r, s, 2 * rays.drawn, rays);
      } else if ((rays.unanimous() ? agreed_error : mixed_error) > allowed) {
        list.rays += rays.all;
        divide(r, s, candidates, list, deferred);
        return;
      }
      const bool counts = !single && coherence * mixed_error > allowed;
      const bool near_r = counts && occluder_near(r, candidates);
      const bool near_s = counts && occluder_near(s, candidates);
      // a few rays that agree are no proof where much is half hidden all around
      if (near_r || near_s) {
        while (rays.unanimous() && rays.drawn < agreeing_rays) {
          rays_.cast(r, s, rays.drawn + first_rays, rays);
        }
      }
      list.rays += rays.all;
      if (!rays.unanimous() && divide_one(r, s, near_r, near_s, candidates, list, deferred)) return;
      if (rays.all > 0 && rays.visible == 0) {
        ++list.hidden;
        return;
      }
    } else {
      ++list.unhidden;
    }
    if (single && (ratio > near_ratio || straddling_r || straddling_s)) {
      store_near(r, s, visible_share(kernel, rays),
                 std::min(near_share * options_.block_error / std::max(bright_r, bright_s), near_share),
                 list);
    } else {
      store(r, s, kernel, rays, bright_r, bright_s, list);
    }
  }

  // Single patches whose nodes are too far apart for the kernel between them.
  void store_near(const BlockEnd& r, const BlockEnd& s, double visible, double tolerance,
                  BlockList& list) const {
    const Polygon p = clip(r.bounds.hull, s.bounds.plane, plane_tolerance);
    const Polygon q = clip(s.bounds.hull, r.bounds.plane, plane_tolerance);
    if (p.count == 0 || q.count == 0) return;
    const double exchange = contour_exchange(p, q, tolerance * std::min(r.area, s.area));
    if (!(exchange > 0)) return;
    ++list.entries;
    list.scalars.push_back(
        {r.cluster, s.cluster, static_cast<float>(visible * exchange / (r.area * s.area))});
  }

  // The kernel with what rays left of it, as simply as the allowed error admits. A single patch has one
  // value.
  void store(const BlockEnd& r, const BlockEnd& s, const BlockKernel& kernel, const RayCount& rays,
             double bright_r, double bright_s, BlockList& list) const {
    std::array<double, 16> values = kernel.values;
    if (rays.all > 0) {
      for (int k = 0; k < 16; ++k) values[k] *= rays.share(k);
    }
    std::array<double, 4> of_r{}, of_s{};
    double mean = 0;
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        of_r[a] += s.weights[b] * values[4 * a + b];
        of_s[b] += r.weights[a] * values[4 * a + b];
      }
    }
    for (int a = 0; a < 4; ++a) mean += r.weights[a] * of_r[a];
    double along_r = 0, along_s = 0;  // largest change of the kernel if a side is taken for constant
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        along_r = std::max(along_r, std::abs(values[4 * a + b] - of_s[b]));
        along_s = std::max(along_s, std::abs(values[4 * a + b] - of_r[a]));
      }
    }
    const double weight = std::max(s.area * bright_s, r.area * bright_r);
    const double small = collapse_share * options_.block_error;
    const bool constant_r = r.single || along_r * weight <= small;
    const bool constant_s = s.single || along_s * weight <= small;
    const auto narrow = [](const auto& wide, auto& result) {
      for (std::size_t k = 0; k < wide.size(); ++k) result[k] = static_cast<float>(wide[k]);
    };
    if (constant_r && constant_s) {
      list.scalars.push_back({r.cluster, s.cluster, static_cast<float>(mean)});
      list.entries += r.single && s.single;
    } else if (constant_s) {
      narrow(of_r, list.linears.emplace_back(LinearBlock{r.cluster, s.cluster, {}}).values);
    } else if (constant_r) {
      narrow(of_s, list.linears.emplace_back(LinearBlock{s.cluster, r.cluster, {}}).values);
    } else {
      narrow(values, list.bilinears.emplace_back(BilinearBlock{r.cluster, s.cluster, {}}).values);
    }
  }

  const PatchHierarchy& hierarchy_;
  const HidingScene& scene_;
  const Brightness& brightness_;
  const AssemblyOptions& options_;
  double kink_;  // what a plane may send to an end that it straddles
  double near_;  // radii within which an occluder is near
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
