#pragma once

#include <cstdint>
#include <vector>

#include "luxel/gather_operator.h"
#include "transport/gather/hit_map.h"

namespace luxel {

/// Sixteen patches as vector code wants them: coordinates of the ray scene, one number a lane. Idle lanes
/// repeat the first.
struct alignas(64) PacketFrame {
  static constexpr int lanes = GatherOperator::lanes;

  // points of a patch: corner + s first + t second in its first triangle, corner + s second + t third in the
  // other, s + t <= 1; `share` is the first triangle's share of the area
  float corner[3][lanes], first[3][lanes], second[3][lanes], third[3][lanes], share[lanes];
  float tangent[3][lanes], bitangent[3][lanes], normal[3][lanes];
  std::uint32_t seeds[4][lanes];  ///< of points and of the lower digits of directions
  std::int32_t
      enclosure[lanes];       ///< a closed one, beyond which nothing can be met; -1: not known to be closed
  std::int32_t valid[lanes];  ///< -1 in use, 0 idle
  std::uint32_t shared_seeds[2];  ///< of the upper digits of directions; last, so that all rows are aligned
};

/// What all packets share.
struct PacketScene {
  void* embree = nullptr;                ///< RTCScene
  const std::uint32_t* words = nullptr;  ///< reversed_sobol_words, 4 a ray, or 4 rows of one a lane
  bool lane_words = false;               ///< each lane has a point of the net for itself
  std::uint32_t lower_digits = 0;        ///< mask of the digits of a direction that are a lane's own
  const HitMap* map = nullptr;
  std::int32_t nothing = 0;                  ///< what a lost ray met
  const std::int32_t* enclosures = nullptr;  ///< of each patch, and of `nothing`; null: all open
};

/// A ray whose end float cannot tell for certain, in the ray scene's coordinates.
struct DoubtfulRay {
  int ray;  ///< from 0: the first of the call
  int lane;
  bool lost;  ///< met nothing, a back or another cell; else: the map does not know
  float origin[3], direction[3];
  int triangle;  ///< met, with barycentric coordinates and side; only where it is not lost
  float u, v;
  bool front;
};

/// Traces rays first .. first + count of a packet; patches met go to `met`, count x lanes, and those to be
/// settled with more care to `doubtful`, with `nothing` in their place.
void trace_packet(const PacketScene& scene, const PacketFrame& frame, int first, int count,
                  std::uint32_t* met, std::vector<DoubtfulRay>& doubtful);

}  // namespace luxel
