#pragma once

namespace framewatch::daemon {

/// From now on SIGHUP does not end the process.
void catch_reload_signal();
/// Whether a SIGHUP has come since the last call.
bool reload_requested();

/// From now on SIGINT and SIGTERM do not end the process by themselves.
void catch_stop_signals();
/// Whether SIGINT or SIGTERM has come.
bool stop_requested();

}  // namespace framewatch::daemon
