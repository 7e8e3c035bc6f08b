// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/monitor/history/history_points.h"
#include "daemon/monitor/history/summary_query.h"
#include "daemon/monitor/history/weather_effects.h"

namespace framewatch::daemon {

/// A viewer's question to the history: a span, and the elements to show of it.
struct YearsRequest {
  static constexpr std::size_t kMostElements = 8;

  std::optional<std::int64_t> from_us, to_us;  ///< nullopt: the beginning, the end of the history
  std::optional<std::int64_t> last_us;         ///< or this long, counted back from the end
  std::vector<std::string> elements;           ///< names of parameters
  bool only_elements = false;                  ///< without weather, events and notes
};

/// Reads the arguments of /years.json: times as `framewatch history` takes them, names with commas
/// between, and "elements" or nothing. Returns nullopt, with the reason in `problem`, if they break
/// a rule.
std::optional<YearsRequest> read_years_request(const std::string& from, const std::string& to,
                                               const std::string& last, const std::string& elements,
                                               const std::string& only, std::string& problem);

/// How far the model of the weather is.
struct WeatherModel {
  enum class State { fitting, ready, failed };
  State state = State::fitting;
  std::string problem;                            ///< of `failed`
  std::shared_ptr<const WeatherEffects> effects;  ///< null before the first fit
};

/// An answer over HTTP: JSON with 200, otherwise a sentence.
struct YearsAnswer {
  unsigned code = 200;
  std::string text;
};

/// Answers a request from an open history: docs/dashboard.md, Day, month, year. all: what
/// history_extent() of these summaries returns.
YearsAnswer answer_years(const YearsRequest& request, SummaryQuery& summaries,
                         const std::optional<HistoryExtent>& all, const WeatherModel& model);

}  // namespace framewatch::daemon
