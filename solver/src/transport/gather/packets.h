#pragma once

#include <vector>

#include "luxel/gather_operator.h"

namespace luxel {

/// Patches in packets of neighbours, whose rays keep together: first those of each side of a flat polygon
/// along a space-filling curve, shared out evenly, then the rest by facing and place. Cost: n log n.
std::vector<GatherOperator::Packet> packets_of(const PatchMesh& mesh);

/// Patches in use: the lanes before the first idle one.
int used_lanes(const GatherOperator::Packet& packet);

}  // namespace luxel
