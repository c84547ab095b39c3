#include "form_factors/ray_visibility.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include "form_factors/occluder_scene.h"
#include "form_factors/sight_lines.h"

namespace luxel {

namespace {

// The most rays of any pair, a power of two.
constexpr int most_rays = 1 << 16;

// Of all shares the one that rays find worst.
constexpr double half = 0.5;

// A pair while its rays are under way.
struct Trial {
  SightLines lines;
  int traced = 0;         // lines of the sequence used
  int wanted = 0;         // to be used by the end of this round
  double weight = 0;      // of all rays
  double visible = 0;     // of those that arrive
  double squares = 0;     // of the weights
  std::int64_t rays = 0;  // cast

  double share() const { return weight > 0 ? visible / weight : 1; }
  double error() const {
    if (!(weight > 0)) return 0;
    return share_error(share(), weight * weight / squares);  // as many equal rays
  }
};

}  // namespace

double share_error(double share, double rays) {
  const double p = (share * rays + share_prior) / (rays + 2 * share_prior);
  return share_error_constant * std::sqrt(p * (1 - p)) * std::pow(rays, -share_error_order);
}

double worst_share_error(int rays) {
  return share_error_constant * half * std::pow(rays, -share_error_order);
}

int first_rays(double relative_tolerance) {
  static const std::vector<double> errors = [] {
    std::vector<double> of;
    for (int rays = 1; rays < most_first_rays; rays *= 2) of.push_back(worst_share_error(rays));
    return of;
  }();
  int rays = 1;
  for (const double error : errors) {
    if (error <= relative_tolerance) break;
    rays *= 2;
  }
  return rays;
}

RayVisibility::RayVisibility(const ClusterTree& tree, const OccluderScene& scene, std::uint64_t seed)
    : tree_(tree), scene_(scene), seed_(seed) {}

std::vector<RayShare> RayVisibility::visible(std::span<const RayPair> pairs) const {
  std::vector<Trial> trials;
  trials.reserve(pairs.size());
  std::vector<std::size_t> open(pairs.size());
  std::deque<FacingParts> clipped;  // trials point into it
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    open[k] = k;
    const WorkPatch *a = &tree_.patches[pairs[k].s], *b = &tree_.patches[pairs[k].t];
    if (FacingParts parts = facing_parts(*a, *b); parts.clipped) {
      const FacingParts& kept = clipped.emplace_back(std::move(parts));
      a = &kept.a;
      b = &kept.b;
    }
    trials.push_back({SightLines(*a, *b, seed_), 0, first_rays(pairs[k].tolerance / pairs[k].unhidden)});
  }
  SightPacket packet(scene_, [&](std::size_t k, double weight, bool arrives) {
    Trial& trial = trials[k];
    trial.weight += weight;
    trial.squares += weight * weight;
    if (arrives) trial.visible += weight;
    ++trial.rays;
  });
  while (!open.empty()) {
    for (std::size_t k : open) {
      Trial& trial = trials[k];
      for (; trial.traced < trial.wanted; ++trial.traced) {
        const SightLine line = trial.lines[trial.traced];
        if (line.weight > 0) packet.add(k, line);
      }
    }
    packet.trace();
    std::erase_if(open, [&](std::size_t k) {
      return trials[k].wanted >= most_rays || trials[k].error() * pairs[k].unhidden <= pairs[k].tolerance;
    });
    for (std::size_t k : open) trials[k].wanted *= 2;
  }
  std::vector<RayShare> shares(pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    shares[k] = {trials[k].share(), trials[k].error(), trials[k].rays};
  }
  return shares;
}

}  // namespace luxel
