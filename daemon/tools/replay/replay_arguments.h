#pragma once

#include <string>
#include <vector>

#include "daemon/tools/replay/replay_survey.h"

namespace framewatch::daemon {

struct ReplayArguments {
  std::string config;
  std::vector<std::string> inputs;  ///< LCM event logs and record files, in order of time
  std::string out;                  ///< .lcmlog, .csv, .csv.gz or .mat; empty: only the summary
  bool salvage = false;             ///< replay what is intact of damaged input
  bool quiet = false;
  bool json = false;                ///< summary as JSON
  bool boxplot = false;             ///< boxplot statistics in .csv and .mat
  RecordFileArguments record = {};  ///< what record files do not say themselves
  ReplaySpan span = {};
  bool one_pass = false;            ///< not tuned on the input first
  double speed = 0;                 ///< times real time; 0: as fast as possible
  bool lcm = false;                 ///< publish too
  std::string lcm_url = {};         ///< empty: the configuration's
  std::string expect = {};          ///< expectation file to hold the replay to
  std::string write_expect = {};    ///< expectation file to write
  std::string load_state = {};      ///< file to go on from
  std::string save_state = {};      ///< file to go on from later: the input has not ended
  std::string write_baseline = {};  ///< baseline file of [watch] to write
  std::string event_reports = {};   ///< folder for the reports of [event_report]; empty: none
  std::string floors = {};          ///< CSV of every floor's motion to write; empty: none
  std::string junit = {};           ///< result of `expect` for a CI system
};

/// Whether one of the outputs is named -.
bool writes_standard_output(const ReplayArguments& arguments);

/// Whether an output is the tables of a history.
bool is_history(const std::string& out);

/// What can be said before any file is read.
std::vector<std::string> argument_problems(const ReplayArguments& arguments);

}  // namespace framewatch::daemon
