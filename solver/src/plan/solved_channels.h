#pragma once

#include "luxel/plan.h"

namespace luxel {

/// A plan that leaves no channel out.
ChannelPlan every_channel(int count);

/// All channels from those that were solved, N x m each.
PatchField expanded(const PatchField& solved, const ChannelPlan& channels);

}  // namespace luxel
