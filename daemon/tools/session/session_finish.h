// SPDX-License-Identifier: MIT
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

/// Finishes a session whose logs are closed, or were cut off by a crash: finds the stages, converts
/// the logs, writes the report. Missing estimates are computed again from the raw samples. The logs
/// stay unchanged, except that partial files of a crash get their final names. Returns the exit
/// code: 1 when a step failed; session.json has the reasons.
int finish_session(const FinishArguments& arguments);

}  // namespace framewatch::daemon
