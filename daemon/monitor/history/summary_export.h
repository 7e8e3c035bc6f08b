#pragma once

#include <string>
#include <vector>

#include "daemon/monitor/history/summary_query.h"

namespace framewatch::daemon {

struct NamedSummaries {
  SummaryParameter parameter;
  std::vector<SummaryRow> rows;
};

/// Writes summaries of one period as PATH: .csv or .csv.gz, one row per parameter and period, or
/// .mat, periods x parameters (docs/history.md). Empty, or why not; then nothing is there.
std::string write_summaries(const std::string& path, std::int64_t period_s,
                            const std::vector<NamedSummaries>& summaries);

}  // namespace framewatch::daemon
