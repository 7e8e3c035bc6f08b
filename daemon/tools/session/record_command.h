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
  std::string send;              ///< verb to send to the recorder that runs; empty: none
  std::string finish;            ///< folder of a session to finish; empty: none
  double tap_s = 0;              ///< tap test of at most so long before the session; 0: none
  bool check = true;             ///< wait for a check of the channels
  bool strict = false;           ///< do not begin when a channel has a problem
  std::string reports;           ///< folder for reports; empty: the session's own
  bool csv = false, mat = false, split = false, report = true;
  bool quiet = false;
  bool by_name = false;  ///< nodes name the channels that have no source
  double wait_s = 60;    ///< for the first samples, without `standby`
};

/// framewatch record: one session; with `standby` one session per command until SIGINT or SIGTERM.
/// Exit code.
int record(const RecordArguments& arguments);

}  // namespace framewatch::daemon
