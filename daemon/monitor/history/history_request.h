// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/summary_query.h"

namespace framewatch::daemon {

/// The command line of `framewatch history`.
struct HistoryArguments {
  std::string place;                    ///< configuration file, or directory of a history
  std::string from, to;                 ///< UTC, or seconds since 1970
  std::string last;                     ///< such as "2h": counted back from the newest data
  int period_s = 0;                     ///< 0: the one that fits
  std::vector<std::string> parameters;  ///< names, with * and ?; empty: all
  std::string out;                      ///< summaries: .csv, .csv.gz, .mat
  std::string raw;                      ///< raw samples: .lcmlog, .csv, .csv.gz, .mseed
  std::vector<std::string> channels;    ///< patterns for raw samples; empty: all
  std::string network = "XX", station = "FRAME";  ///< for miniSEED
  bool events = false;
  bool losses = false;
  std::string report;  ///< page about months or years
  std::string
      weather;  ///< table for --losses and --report, see read_weather(); empty: the kept one
  std::string weather_out;  ///< table of the kept weather: .csv, .csv.gz
  bool json = false;
};

/// The command line with times, periods and parameters looked up in the history.
struct HistoryRequest {
  std::string directory;
  std::optional<Config> config;  ///< empty: the directory itself was named
  std::int64_t from_us = -kEver_us, to_us = kEver_us;
  std::int64_t period_s = 0;
  std::vector<SummaryParameter> parameters;
};

/// Opens the history and looks up what the arguments name. Returns nullopt, with every problem,
/// when something does not exist or is malformed.
std::optional<HistoryRequest> read_history_request(const HistoryArguments& arguments,
                                                   SummaryQuery& summaries,
                                                   std::vector<std::string>& problems);

/// Parses "90m", "2h", "3d", "45s" or "45". Returns microseconds, or nullopt if `text` is not a
/// duration > 0.
std::optional<std::int64_t> read_duration(const std::string& text);

/// Returns true if a name matches one of the patterns, with * and ?, or if there are no patterns.
bool is_chosen(const std::vector<std::string>& patterns, const std::string& name);

/// Appends a problem for each pattern that matches no name. `option` is where the patterns were
/// given.
void check_patterns(const char* option, const std::vector<std::string>& patterns,
                    const std::vector<std::string>& names, std::vector<std::string>& problems);

}  // namespace framewatch::daemon
