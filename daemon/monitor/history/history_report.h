// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/monitor/history/history_days.h"
#include "daemon/monitor/history/history_losses.h"
#include "daemon/monitor/history/summary_query.h"
#include "daemon/monitor/history/weather_table.h"

namespace framewatch::daemon {

/// Returns a page about months or years: losses, every element day by day, its weather, how much of
/// each day had values, and the newest events.
std::string history_page(const std::string& structure, const std::vector<ElementDays>& elements,
                         const HistoryLosses& losses, const HistoryLosses& damping,
                         const WeatherTable& weather, const std::vector<event_t>& events,
                         const std::vector<StoredAcknowledgement>& acknowledgements);

}  // namespace framewatch::daemon
