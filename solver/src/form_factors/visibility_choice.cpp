#include "form_factors/visibility_choice.h"

#include <cmath>

#include "form_factors/ray_visibility.h"

namespace luxel {

namespace {

// Costs [us], measured: a pair clipped against k occluders takes clip_cost + clip_growth k^2, a ray ray_cost,
// and a pair that rays measure ray_pair_cost besides; rays for a relative tolerance t are about
// (ray_need / t)^(1 / share_error_order).
constexpr double clip_cost = 3, clip_growth = 0.3, ray_cost = 0.06, ray_need = 0.4;
constexpr double ray_pair_cost = 0.05;

// A pair of a block with k candidates takes block_cost + block_growth k [us], those in full sight and hidden
// blocks counted, where it is found out pair by pair what stands between and what of it hides, sorted_cost
// where rays sort the block.
constexpr double block_cost = 0.3, block_growth = 0.06, sorted_cost = 0.45;

// Blocks are handed to rays as a whole where so many occluders stand in the way for each patch of a side:
// where there are fewer, smaller blocks have fewer still.
constexpr double occluders_a_patch = 0.75;

}  // namespace

bool rays_are_cheaper(std::size_t occluders, double relative_tolerance) {
  if (occluders <= few_occluders) return false;
  const double k = static_cast<double>(occluders);
  return ray_cost * std::pow(ray_need / relative_tolerance, 1 / share_error_order) <
         clip_cost + clip_growth * k * k;
}

bool rays_sort(int side, std::size_t candidates, std::size_t few) {
  return candidates > few && static_cast<double>(candidates) > occluders_a_patch * side;
}

int few_rays(double relative_tolerance) {
  const int rays = first_rays(relative_tolerance);
  return rays < most_first_rays || worst_share_error(rays) <= relative_tolerance ? rays : 0;
}

double few_rays_cost(int rays) {
  return ray_pair_cost + ray_cost * rays;
}

double block_pair_cost(int side, std::size_t candidates) {
  return rays_sort(side, candidates) ? sorted_cost
                                     : block_cost + block_growth * static_cast<double>(candidates);
}

}  // namespace luxel
