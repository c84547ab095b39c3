#pragma once

#include <string>

#include "luxel/report.h"

namespace luxel::app {

/// The report's form factors between groups, and from a point to groups, as aligned tables; empty where it
/// has none.
std::string factor_tables(const Report& report);

}  // namespace luxel::app
