#pragma once

#include <string>
#include <vector>

namespace framewatch::daemon {

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

/// framewatch history: what a history holds, and parts of it as files. Exit code.
int history(const HistoryArguments& arguments);

}  // namespace framewatch::daemon
