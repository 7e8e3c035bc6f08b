#pragma once

#include <optional>
#include <string>

#include "daemon/session_file.h"
#include "daemon/web_server.h"

namespace framewatch::daemon {

/// The newest 200 sessions of a folder, newest first: [{"session", "test", "operator", "state",
/// "began_us", "seconds", "problems", "report"}], JSON.
std::string sessions_json(const std::string& folder);

/// report.html or session.json of one session, by "NAME/report.html"; empty for anything else,
/// whatever is in the folder.
std::optional<WebFile> session_document(const std::string& folder, const std::string& path);

}  // namespace framewatch::daemon
