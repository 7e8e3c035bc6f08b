// SPDX-License-Identifier: MIT
#pragma once

namespace framewatch::daemon {

/// Installs a handler, so that SIGHUP does not end the process.
void catch_reload_signal();
/// Returns true if SIGHUP arrived since the last call.
bool reload_requested();

/// Installs handlers, so that SIGINT and SIGTERM do not end the process.
void catch_stop_signals();
/// Returns true if SIGINT or SIGTERM has arrived.
bool stop_requested();

}  // namespace framewatch::daemon
