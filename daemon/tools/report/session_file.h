// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/tools/report/session_motion.h"

namespace framewatch::daemon {

/// Statistics of one channel over some time. Calibrated, m/s^2.
struct ChannelResult {
  std::string name;
  double noise_density = 0;  ///< m/s^2/sqrt(Hz), above a quarter of the sampling rate; NaN: unknown
  double rms = 0;            ///< without the mean
  double offset = 0;         ///< mean
  double peak = 0;           ///< largest distance from zero
  double range = 0;          ///< of the sensor; 0: unknown
  std::int64_t samples = 0, missing = 0, saturated = 0, stuck = 0;
  int polarity = 0;     ///< by the tap test: 1 right, -1 reversed, 0 not tapped
  std::string problem;  ///< one sentence; empty: no problem
};

/// The settings of a session that the user chooses.
struct SessionRequest {
  std::string test, operator_name, notes;
  double length_s = 0;       ///< 0: until stopped
  double trigger_mps2 = 0;   ///< 0: begins at once
  double pre_trigger_s = 0;  ///< time stored from before the trigger
};

/// Content of session.json in the folder of a session (docs/recording.md).
struct SessionFile {
  std::string state;  ///< recording, recorded, finished
  SessionRequest request;
  std::string asked_by;  ///< user who gave the command; empty: started without a command
  std::string config_path, config_sha256, version;
  std::int64_t began_us = 0;                ///< host clock
  std::int64_t trigger_us = 0, end_us = 0;  ///< sensor time of start or trigger, and of the end
  std::string triggered_by;                 ///< channel; empty: started without a trigger
  std::string ended_by;                     ///< command, length, signal, no samples
  std::int64_t messages = 0, estimates = 0, lost = 0, dropped = 0;
  std::vector<ChannelResult> check, run;  ///< before the session, and during it
  std::vector<Stage> stages;              ///< of a finished session
  std::vector<std::string> files;         ///< beside session.json
  std::string report;                     ///< path; empty: no report
  std::vector<std::string> problems;      ///< of the recording, one sentence each
  std::vector<std::string> finishing;     ///< notes from finishing the session
};

std::string session_json(const SessionFile& session);
/// Parses the text of a session.json. Returns nullopt and sets `error` when it is not valid.
std::optional<SessionFile> parse_session(const std::string& text, std::string& error);
/// Reads a session.json. Returns nullopt and sets `error` when it cannot be read or is not valid.
std::optional<SessionFile> read_session_file(const std::string& path, std::string& error);

/// Returns "2026-11-21T14-03-10_el-centro-30-deg": the time and the test's name, reduced to
/// characters that are valid in file names.
std::string session_folder_name(std::int64_t began_us, const std::string& test);

/// Returns one sentence for every invalid value of a request.
std::vector<std::string> problems(const SessionRequest& request);

}  // namespace framewatch::daemon
