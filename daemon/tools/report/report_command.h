#pragma once

#include <string>
#include <utility>
#include <vector>

#include "daemon/tools/report/session_report.h"

namespace framewatch::daemon {

struct ReportArguments {
  std::string estimates;         ///< LCM event log of estimates
  std::string out;               ///< empty: beside the log, .html
  std::string config;            ///< needed with raw
  std::vector<std::string> raw;  ///< logs and record files, in order of time
  RecordFileArguments record;    ///< what such record files do not say themselves
  std::string title, test, operator_name, notes;
  std::string floors;   ///< JSON of every floor's motion to write; empty: none
  std::string drifts;   ///< JSON of drifts, damage and placard to write; empty: none
  std::string session;  ///< session.json of `framewatch record`; empty: none
  bool quiet = false;
};

/// Evaluates a session and writes its page, which lists `files` (use, path) with their SHA-256.
/// floors_path: also the JSON of every floor's motion, of a building of groups with motion;
/// drifts_path: also that of drifts, damage and placard, with motion.
/// Returns an empty string, or the reason of a failure; then there is no page.
std::string write_report(SessionReport session,
                         const std::vector<std::pair<std::string, std::string>>& files,
                         const std::string& path, const std::string& floors_path = {},
                         const std::string& drifts_path = {});

/// framewatch report: one self-contained HTML page of a session. Exit code.
int report(const ReportArguments& arguments);

}  // namespace framewatch::daemon
