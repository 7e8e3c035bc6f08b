#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/config.h"
#include "daemon/history_command.h"
#include "daemon/summary_query.h"

namespace framewatch::daemon {

/// What is asked of a history, as it is there.
struct HistoryRequest {
  std::string directory;
  std::optional<Config> config;  ///< none: the directory itself was named
  std::int64_t from_us = -kEver_us, to_us = kEver_us;
  std::int64_t period_s = 0;
  std::vector<SummaryParameter> parameters;

  static constexpr std::int64_t kEver_us = INT64_MAX / 4;
};

/// Opens the history and finds what is asked for. Empty, with every problem, when something is not
/// there or not well said.
std::optional<HistoryRequest> read_history_request(const HistoryArguments& arguments,
                                                   SummaryQuery& summaries,
                                                   std::vector<std::string>& problems);

/// Whether a name is one of the patterns, with * and ?; no patterns: it is.
bool is_chosen(const std::vector<std::string>& patterns, const std::string& name);

/// A problem for each pattern that is none of the names; `option` is what a person wrote it after.
void check_patterns(const char* option, const std::vector<std::string>& patterns,
                    const std::vector<std::string>& names, std::vector<std::string>& problems);

}  // namespace framewatch::daemon
