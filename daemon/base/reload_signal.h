#pragma once

namespace framewatch::daemon {

/// From now on SIGHUP does not end the process.
void catch_reload_signal();
/// Whether a SIGHUP has come since the last call.
bool reload_requested();

}  // namespace framewatch::daemon
