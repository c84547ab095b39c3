#include "patch_limit.h"

#include "luxel/input_error.h"

namespace luxel {

void refuse_too_many(const Scene& scene, double count, int limit) {
  if (count <= limit) return;
  throw InputError((scene.file.empty() ? "" : scene.file + ": ") + "about " +
                   std::to_string(static_cast<long long>(count)) +
                   " patches would result, expected at most " + std::to_string(limit));
}

}  // namespace luxel
