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

  enum class Shape { triangles, parallelograms, quads };

  // Points of a patch, s and t in [0, 1): of a parallelogram corner + s first + t third; of a triangle corner
  // + s first + t second, the square folded to s + t <= 1; of another quad the same in its first triangle,
  // and corner + s second + t third in the other. `share` is the first triangle's share of the area.
  float corner[3][lanes], first[3][lanes], second[3][lanes], third[3][lanes];
  float share[lanes], first_scale[lanes], other_scale[lanes];  ///< 1 / share, 1 / (1 - share)
  float tangent[3][lanes], bitangent[3][lanes], normal[3][lanes];
  /// What of a point of the packet's net is turned over in each lane: all digits of places, the lower ones of
  /// directions. A net with some digits turned over in all points is one again, as evenly spread.
  std::uint32_t turned[4][lanes];
  std::int32_t
      enclosure[lanes];       ///< a closed one, beyond which nothing can be met; -1: not known to be closed
  std::int32_t valid[lanes];  ///< -1 in use, 0 idle
  std::uint32_t seeds[4];     ///< of the scrambling of the net; last, so that all rows are aligned
  Shape shape;                ///< of all lanes
};

/// A row of memory for each patch.
struct PatchRows {
  const char* first = nullptr;  ///< null: none
  std::size_t bytes = 0;        ///< of a row
};

/// What all packets share.
struct PacketScene {
  void* embree = nullptr;                ///< RTCScene
  const std::uint32_t* words = nullptr;  ///< net_words()
  const HitMap* map = nullptr;
  std::int32_t nothing = 0;  ///< what a lost ray met
  const std::int32_t* enclosures =
      nullptr;             ///< of each patch, and of `nothing`; null: a ray cannot leave its own
  PatchRows rows;          ///< those of patches met will be read soon
  bool doubt_lost = true;  ///< lost rays are doubtful
};

/// reversed_sobol_words for `count` points, and up to a multiple of 16: blocks of 16 points, 4 rows a block.
std::vector<std::uint32_t> net_words(int count);

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
