#pragma once

#include <cstddef>

namespace luxel {

// What pairs may err by, and which way there is the cheapest.

/// Errors of single pairs have either sign; rows of n pairs, each with A sqrt(G_ij min(A_i, A_j)) times this,
/// err by A times this in the root mean square.
constexpr double pair_share = 0.3;

/// Rays err independently, clipping does not: their share is larger, such that the largest of 10,000 rows
/// (four standard deviations) stays below 2 A.
constexpr double ray_share = 0.7;

/// Up to so many occluders between a pair, clipping is always the cheaper way where few rays do not suffice.
constexpr std::size_t few_occluders = 6;

/// Whether rays that are looked at on the way cost less than clipping.
bool rays_are_cheaper(std::size_t occluders, double relative_tolerance);

/// Whether blocks with so many candidates, and so many patches on their longer side, are sorted by rays:
/// tests of single pairs cost more where many small occluders stand in the way.
/// @param few  so many candidates are never left to rays
bool rays_sort(int side, std::size_t candidates, std::size_t few = few_occluders);

/// Rays that suffice for a pair whatever they find, most_first_rays at most; 0: more are needed.
int few_rays(double relative_tolerance);

/// CPU time [us] of a pair that so many rays measure, and of one of a block where it has to be found out
/// first what stands between.
double few_rays_cost(int rays);
double block_pair_cost(int side, std::size_t candidates);

}  // namespace luxel
