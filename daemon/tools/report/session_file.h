#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/tools/report/channel_result.h"
#include "daemon/tools/report/session_motion.h"

namespace framewatch::daemon {

/// What a person asks of a session.
struct SessionRequest {
  std::string test, operator_name, notes;
  double length_s = 0;       ///< 0: until stopped
  double trigger_mps2 = 0;   ///< 0: begins at once
  double pre_trigger_s = 0;  ///< stored from before the trigger
};

/// The content of session.json in the folder of a session (docs/recording.md).
struct SessionFile {
  std::string state;  ///< recording, recorded, finished
  SessionRequest request;
  std::string asked_by;  ///< user who gave the command; empty: none was given
  std::string config_path, config_sha256, version;
  std::int64_t began_us = 0;                ///< host clock
  std::int64_t trigger_us = 0, end_us = 0;  ///< sensor time of start or trigger, and of the end
  std::string triggered_by;                 ///< channel; empty: nothing, it was started
  std::string ended_by;                     ///< command, length, signal, no samples
  std::int64_t messages = 0, estimates = 0, lost = 0, dropped = 0;
  std::vector<ChannelResult> check, run;  ///< before the session, and of it
  std::vector<Stage> stages;              ///< finished
  std::vector<std::string> files;         ///< beside session.json
  std::string report;                     ///< path; empty: there is none
  std::vector<std::string> problems;      ///< of the recording, one sentence each
  std::vector<std::string> finishing;     ///< what is to be known of what came after it
};

std::string session_json(const SessionFile& session);
/// The session of such a text; empty, with the reason, when it is none.
std::optional<SessionFile> parse_session(const std::string& text, std::string& error);
/// Empty, with the reason, when the file cannot be read or is no session.
std::optional<SessionFile> read_session_file(const std::string& path, std::string& error);

/// "2026-11-21T14-03-10_el-centro-30-deg", with those characters of the test's name that are valid
/// in file names.
std::string session_folder_name(std::int64_t began_us, const std::string& test);

/// One sentence for every invalid value of a request.
std::vector<std::string> problems(const SessionRequest& request);

}  // namespace framewatch::daemon
