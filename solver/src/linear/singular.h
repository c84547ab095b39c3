#pragma once

#include "linear/system.h"

namespace luxel {

/// Refuses a system without a unique solution: an enclosure (patches that see each other, over any number of
/// bounces) in which no patch loses light, 1 - rho_i s_i = 0 up to rounding. One patch that loses some,
/// however far, makes it regular. Cost: one application of F for each bounce that it takes to reach a loss
/// from everywhere, and none where every patch loses light.
/// @throws SingularSystem naming the enclosure by its first patch
void refuse_singular(const RadiositySystem& system);

}  // namespace luxel
