#pragma once

namespace luxel::app {

/// From now on Ctrl-C (SIGINT) and SIGTERM do not end the process but set a flag; a second one ends it.
void watch_for_interruption();

/// Whether Ctrl-C was pressed.
bool interruption_requested();

}  // namespace luxel::app
