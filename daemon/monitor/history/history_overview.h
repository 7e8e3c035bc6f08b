// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/monitor/history/summary_query.h"

namespace framewatch::daemon {

/// Returns an overview of a history on one screen: raw logs, summaries, boxplots of the last
/// period, losses, events.
std::string history_overview(const std::string& directory, SummaryQuery& summaries);

/// Returns the overview as JSON, schema `framewatch.history/1`.
std::string history_json(const std::string& directory, SummaryQuery& summaries);

std::string event_line(const event_t& event);

std::string acknowledgement_line(const StoredAcknowledgement& acknowledgement);

/// Returns a size such as "4.2 MB".
std::string size_text(std::int64_t bytes);

}  // namespace framewatch::daemon
