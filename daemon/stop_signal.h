#pragma once

namespace framewatch::daemon {

/// From now on SIGINT and SIGTERM end nothing by themselves.
void catch_stop_signals();
/// Whether one has come.
bool stop_requested();

}  // namespace framewatch::daemon
