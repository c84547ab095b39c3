#pragma once

#include <vector>

#include "luxel/enclosures.h"
#include "luxel/gather_operator.h"

namespace luxel {

/// Enclosures as the rays of a gather show them: patches are joined with those that their stored rays met,
/// and what is lost of all rays is the open share (backs included). An enclosure is closed where no ray was
/// lost.
/// @param row_sums  N: share of all rays that met a patch
/// @param rays      of each patch
Enclosures gathered_enclosures(const GatherOperator& stored, const std::vector<double>& row_sums, int rays);

}  // namespace luxel
