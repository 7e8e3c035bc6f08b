#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/monitor/history/summary_query.h"

namespace framewatch::daemon {

/// What the command line asks of `framewatch history`.
struct HistoryArguments {
  std::string place;                              ///< configuration file, or a history's directory
  std::string from, to;                           ///< UTC, or seconds since 1970
  std::string last;                               ///< "2h" before the newest
  int period_s = 0;                               ///< 0: what fits
  std::vector<std::string> parameters;            ///< names, with * and ?; empty: all
  std::string out;                                ///< summaries: .csv, .csv.gz, .mat
  std::string raw;                                ///< raw samples: .lcmlog, .csv, .csv.gz, .mseed
  std::vector<std::string> channels;              ///< of raw samples; empty: all
  std::string network = "XX", station = "FRAME";  ///< of miniSEED
  bool events = false;
  bool json = false;
};

/// The request with times, periods and parameters looked up in the history.
struct HistoryRequest {
  std::string directory;
  std::optional<Config> config;  ///< none: the directory itself was named
  std::int64_t from_us = -kEver_us, to_us = kEver_us;
  std::int64_t period_s = 0;
  std::vector<SummaryParameter> parameters;

  static constexpr std::int64_t kEver_us = INT64_MAX / 4;
};

/// Opens the history and looks up what is requested. Empty, with every problem, when something does
/// not exist or is malformed.
std::optional<HistoryRequest> read_history_request(const HistoryArguments& arguments,
                                                   SummaryQuery& summaries,
                                                   std::vector<std::string>& problems);

/// Whether a name matches one of the patterns, with * and ?; without patterns every name does.
bool is_chosen(const std::vector<std::string>& patterns, const std::string& name);

/// Appends a problem for each pattern that matches no name; `option`: where it was given.
void check_patterns(const char* option, const std::vector<std::string>& patterns,
                    const std::vector<std::string>& names, std::vector<std::string>& problems);

struct NamedSummaries {
  SummaryParameter parameter;
  std::vector<SummaryRow> rows;
};

/// Writes summaries of one period as PATH: .csv or .csv.gz, one row per parameter and period, or
/// .mat, periods x parameters (docs/history.md). Empty, or why not; then nothing is there.
std::string write_summaries(const std::string& path, std::int64_t period_s,
                            const std::vector<NamedSummaries>& summaries);

/// framewatch history: what a history holds, and parts of it as files. Exit code.
int history(const HistoryArguments& arguments);

}  // namespace framewatch::daemon
