#pragma once

#include <optional>
#include <string>

#include "daemon/page/web/web_files.h"

namespace framewatch::daemon {

/// The newest 200 sessions of a folder, newest first: [{"session", "test", "operator", "state",
/// "began_us", "seconds", "problems", "report"}], JSON.
std::string sessions_json(const std::string& folder);

/// report.html or session.json of a session, by "NAME/report.html" or "NAME/session.json"; empty
/// for any other path.
std::optional<WebFile> session_document(const std::string& folder, const std::string& path);

/// The newest 50 reports of [event_report] in a folder, newest first: [{"name", "verdict",
/// "reason", "start_us", "end_us"}], JSON.
std::string event_reports_json(const std::string& folder);

/// A report by "NAME.html" or "NAME.json"; empty for any other path.
std::optional<WebFile> event_report_document(const std::string& folder, const std::string& path);

}  // namespace framewatch::daemon
