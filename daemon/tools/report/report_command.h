// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "daemon/base/picture_files.h"
#include "daemon/tools/report/session_report.h"

namespace framewatch::daemon {

struct ReportArguments {
  std::string estimates;         ///< LCM event log of estimates
  std::string out;               ///< empty: beside the log, .html
  std::string config;            ///< needed with raw
  std::vector<std::string> raw;  ///< logs and record files, in order of time
  RecordFileArguments record;    ///< options that record files do not state themselves
  std::string title, test, operator_name, notes;
  std::string floors;   ///< JSON file for every floor's motion; empty: no file
  std::string drifts;   ///< JSON file for drifts, damage and placard; empty: no file
  std::string session;  ///< session.json of `framewatch record`; may be empty
  std::string about;    ///< file for the head of the report, see read_about(); may be empty
  PictureFiles figures;
  bool quiet = false;
};

/// Evaluates a session and writes its page, which lists `files` (use, path) with their SHA-256.
/// Returns an empty string, or the reason of a failure.
///
/// floors_path: JSON file for every floor's motion; needs a building of groups and motion.
/// drifts_path: JSON file for drifts, damage and placard; needs motion. figures: for the pictures.
std::string write_report(SessionReport session,
                         const std::vector<std::pair<std::string, std::string>>& files,
                         const std::string& path, const std::string& floors_path = {},
                         const std::string& drifts_path = {}, const PictureFiles& figures = {});

/// Runs `framewatch report`: writes one self-contained HTML page of a session. Returns the exit
/// code.
int report(const ReportArguments& arguments);

}  // namespace framewatch::daemon
