// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "daemon/page/web/web_files.h"

namespace framewatch::daemon {

/// Returns true for names that session_folder_name() makes, which cannot lead out of the folder.
bool is_session_name(const std::string& name);

/// Returns the newest 200 sessions of a folder, newest first, as JSON: [{"session", "test",
/// "operator", "state", "began_us", "seconds", "problems", "report"}].
std::string sessions_json(const std::string& folder);

/// Reads "NAME/report.html" or "NAME/session.json". Returns nullopt for any other path.
std::optional<WebFile> session_document(const std::string& folder, const std::string& path);

/// Returns the newest 50 reports of [event_report] in a folder, newest first, as JSON: [{"name",
/// "verdict", "reason", "start_us", "end_us"}].
std::string event_reports_json(const std::string& folder);

/// Reads the report "NAME.html" or "NAME.json". Returns nullopt for any other path.
std::optional<WebFile> event_report_document(const std::string& folder, const std::string& path);

}  // namespace framewatch::daemon
