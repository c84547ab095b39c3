#pragma once

#include "luxel/scene.h"

namespace luxel {

/// @throws InputError if more than `limit` patches would result.
void refuse_too_many(const Scene& scene, double count, int limit);

}  // namespace luxel
