#pragma once

namespace luxel::app {

/// Gives what earlier stages freed back to the system, which the allocator would keep: at a million patches
/// some 100 MB of the peak. Does nothing for few patches, where it is little. Cost: milliseconds.
void return_freed_memory(int patches);

}  // namespace luxel::app
