#pragma once

// By how much a block may err: what decides where blocks end. Errors are shares of the kernel unless said.
namespace luxel {

// Bilinear interpolation of the kernel between ends of radii r and s at distance d errs by about this times
// ((r + s) / d)^2 of it.
inline constexpr double interpolation_error = 0.5;

// Ends nearer than this, (r + s) / d, are too close for the nodes to tell the kernel; what they exchange is
// then uncertain by this share of it.
inline constexpr double touching_ratio = 0.8;
inline constexpr double touching_error = 0.25;

// Nearer single patches, and those that straddle, get an exact kernel.
inline constexpr double near_ratio = 0.5;

// An end partly behind the other's horizon: the kernel has a kink.
inline constexpr double straddling_error = 0.1;
inline constexpr double straddling_depth = 1e-7;

// What a block with some occluder between may err by before rays are cast, after they agreed, and where they
// do not, beside their own standard error.
inline constexpr double unknown_error = 0.04;
inline constexpr double agreed_error = 0.04;
inline constexpr double mixed_error = 0.12;

// Horizons, near occluders and rough ends change the kernel across an end alike for all parts of the other's
// surroundings, however bright, whose errors then add up, to this many times the accuracy at most.
inline constexpr double coherent_error = 2;

// Several planes' horizons may cross one end: each has this share.
inline constexpr double kink_share = 0.5;

// Across a curved end the horizon errs by this share of what all that is behind it sends, a rough end by this
// share of its roughness.
inline constexpr double kink_error = 0.5;
inline constexpr double rough_error = 0.25;

// The shadow of an occluder `near` radii away changes across an end by 1 / near^2 of this.
inline constexpr double shadow_error = 0.125;

// So many blocks, about, share one shadow's error: smaller ones may be mixed.
inline constexpr double coherence = 14;

}  // namespace luxel
