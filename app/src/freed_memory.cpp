#include "freed_memory.h"

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace luxel::app {

namespace {

// Patches below which all stages together free some 20 MB at most.
constexpr int few_patches = 100'000;

}  // namespace

void return_freed_memory([[maybe_unused]] int patches) {
  if (patches < few_patches) return;
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

}  // namespace luxel::app
