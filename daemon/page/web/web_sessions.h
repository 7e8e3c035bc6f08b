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

}  // namespace framewatch::daemon
