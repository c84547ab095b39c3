#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "transport/gather/packet_kernel.h"

namespace luxel {

/// Room for the rays of many packets, to be used again.
struct SortedRays {
  std::vector<float> origins[3], directions[3];
  std::vector<std::uint16_t> cells;
  std::vector<std::uint32_t> order, starts;
  std::vector<DoubtfulRay> doubtful;  ///< ray: packet x count + ray

  void resize(std::size_t count);
};

/// The same for several packets at once, whose rays are traced by direction and place: where neighbours face
/// different ways, this keeps together what goes the same way. `met` holds packet after packet.
void trace_sorted(const PacketScene& scene, std::span<const PacketFrame> frames, int first, int count,
                  std::uint32_t* met, SortedRays& sorted);

}  // namespace luxel
