// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/tools/replay/replay_survey.h"

namespace framewatch::daemon {

struct ReplayArguments {
  std::string config;
  std::vector<std::string> inputs;  ///< LCM event logs and record files, in order of time
  std::string out;                  ///< .lcmlog, .csv, .csv.gz or .mat; empty: only the summary
  bool salvage = false;             ///< replay the intact parts of damaged input
  bool quiet = false;
  bool json = false;                ///< summary as JSON
  bool boxplot = false;             ///< boxplot statistics in .csv and .mat
  RecordFileArguments record = {};  ///< options that record files do not state themselves
  ReplaySpan span = {};
  bool one_pass = false;            ///< do not tune on the input first
  double speed = 0;                 ///< times real time; 0: as fast as possible
  bool lcm = false;                 ///< publish too
  std::string lcm_url = {};         ///< empty: the configuration's
  std::string expect = {};          ///< expectation file to compare the results with
  std::string write_expect = {};    ///< expectation file to write
  std::string load_state = {};      ///< state file to continue from
  std::string save_state = {};      ///< state file to write; the input is continued later
  std::string write_baseline = {};  ///< baseline file of [watch] to write
  std::string event_reports = {};   ///< folder for the reports of [event_report]; empty: no reports
  std::string floors = {};          ///< CSV file for the motion of every floor; empty: no file
  std::string junit = {};           ///< JUnit file for the result of `expect`
};

/// Returns true if an output is `-`, standard output.
bool writes_standard_output(const ReplayArguments& arguments);

/// Returns the problems of the arguments that show without reading a file.
std::vector<std::string> argument_problems(const ReplayArguments& arguments);

/// Runs `framewatch replay`. Returns the exit code: 1 when a result is not as expected, kBadInput
/// when an argument or the input is wrong or an output cannot be written.
int replay(const ReplayArguments& arguments);

}  // namespace framewatch::daemon
