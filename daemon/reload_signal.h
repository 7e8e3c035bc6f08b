#pragma once

namespace framewatch::daemon {

/// From now on SIGHUP ends nothing.
void catch_reload_signal();
/// Whether one has come since the last call.
bool reload_requested();

}  // namespace framewatch::daemon
