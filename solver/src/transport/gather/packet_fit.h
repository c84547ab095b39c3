#pragma once

#include <array>
#include <span>

#include "luxel/gather_operator.h"

namespace luxel {

/// What sixteen neighbours gathered, m <= 4 columns.
using PacketField = std::array<Eigen::Array4d, GatherOperator::lanes>;

/// Moves the values of neighbours on one plane towards the linear function that fits them best, by the share
/// of their scatter about it that is noise (James and Stein 1961): min(1, noise / scatter). The noise is
/// taken from the means of the first half of the rays against those of all.
/// @returns the share; 0 where the packet is not on one plane, has few patches or follows no line
double fit_packet(const PatchMesh& mesh, std::span<const int> patches, const PacketField& first_half,
                  PacketField& values);

}  // namespace luxel
