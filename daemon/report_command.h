#pragma once

#include <string>
#include <vector>

namespace framewatch::daemon {

struct ReportArguments {
  std::string estimates;         ///< LCM event log of estimates
  std::string out;               ///< empty: beside the log, .html
  std::string config;            ///< needed with raw
  std::vector<std::string> raw;  ///< logs and record files, in order of time
  std::string title, test, operator_name, notes;
  std::string session;  ///< session.json of `framewatch record`; empty: none
  bool quiet = false;
};

/// framewatch report: one self-contained HTML page of a session. Exit code.
int report(const ReportArguments& arguments);

}  // namespace framewatch::daemon
