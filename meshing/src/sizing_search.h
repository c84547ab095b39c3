#pragma once

#include "sized_mesher.h"

namespace luxel {

/// A sizing that gives about n patches, near the edge length `guess` [m]: one length for all parts where that
/// comes within 2 %, else two, in shares that come within 1 % where the steps of the count allow it. Cost:
/// some ten to forty counts.
Sizing find_sizing(SizedMesher& mesher, double guess, double n);

}  // namespace luxel
