#pragma once

#include <string>

#include "daemon/monitor/history/summary_query.h"

namespace framewatch::daemon {

/// What a history holds, on one screen: raw logs, summaries, the last period's boxplots, losses,
/// events.
std::string history_overview(const std::string& directory, SummaryQuery& summaries);

/// The same as JSON, schema `framewatch.history/1`.
std::string history_json(const std::string& directory, SummaryQuery& summaries);

/// One line per event.
std::string event_line(const event_t& event);

std::string acknowledgement_line(const StoredAcknowledgement& acknowledgement);

/// "4.2 MB".
std::string size_text(std::int64_t bytes);

}  // namespace framewatch::daemon
