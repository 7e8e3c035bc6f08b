// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/monitor/history/history_request.h"
#include "daemon/monitor/history/summary_query.h"
#include "daemon/monitor/history/weather_table.h"
#include "estimator/years/years_watch.h"

namespace framewatch::daemon {

/// The losses in the daily means of a history that weather does not explain.
struct HistoryLosses {
  std::vector<std::string> elements;  ///< frame stiffnesses with values
  std::vector<std::string> covariates;
  std::int64_t from_us = 0, to_us = 0;                ///< first and last day
  int days = 0;                                       ///< with values
  std::vector<estimator::YearsWatch::Finding> found;  ///< in order of time
  struct State {
    double median, evidence;
    estimator::LossEvidence::Step step;
  };
  std::vector<State> state;  ///< by element, then of all of them alike
};

/// Watches the frame stiffnesses of a request by their daily means, from the first day on. Returns
/// no elements when the history has no hour with values.
HistoryLosses find_losses(const HistoryRequest& request, SummaryQuery& summaries,
                          const WeatherTable& weather);

std::string losses_text(const HistoryLosses& losses);
std::string losses_json(const HistoryLosses& losses);

}  // namespace framewatch::daemon
