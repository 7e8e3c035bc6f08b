// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/tools/report/session_file.h"

namespace framewatch::daemon {

struct RecordArguments {
  std::string config;
  std::string url;               ///< LCM; empty: the configuration's
  std::string out = "sessions";  ///< folder of the sessions' folders
  SessionRequest request;        ///< pre_trigger_s counts with a trigger only
  bool standby = false;          ///< wait for commands, session after session
  std::string send;              ///< verb to send to the running recorder; empty: record
  std::string finish;            ///< folder of a session to finish; empty: record
  double tap_s = 0;              ///< longest tap test before the session; 0: no tap test
  bool check = true;             ///< wait for a check of the channels
  bool strict = false;           ///< refuse to begin when a channel has a problem
  std::string reports;           ///< folder for reports; empty: the session's own
  bool csv = false, mat = false, split = false, report = true;
  bool quiet = false;
  bool by_name = false;  ///< nodes name the channels that have no source
  double wait_s = 60;    ///< for the first samples, without `standby`
};

/// Runs `framewatch record`: records one session, or with `standby` one session per command until
/// SIGINT or SIGTERM. Returns the exit code.
int record(const RecordArguments& arguments);

}  // namespace framewatch::daemon
