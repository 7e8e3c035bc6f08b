#pragma once

#include <string>

namespace framewatch::daemon {

struct FinishArguments {
  std::string config;
  std::string folder;   ///< of the session
  std::string reports;  ///< folder for the report; empty: the session's own
  bool csv = false, mat = false, split = false;
  bool report = true;
  bool quiet = false;
};

/// What is left to do when a session's logs are closed, or were cut off: the stages, other forms of
/// the logs, the report. Estimates that are missing are made again from the raw samples. The logs
/// themselves are not touched, but for what a crash left under a partial name. Exit code: 1 when
/// something could not be done; session.json says what.
int finish_session(const FinishArguments& arguments);

}  // namespace framewatch::daemon
