#pragma once

#include <string>

namespace luxel::app {

/// Program, version, what it was built with and the licence that a binary of it may be given away under.
std::string version_text();

}  // namespace luxel::app
