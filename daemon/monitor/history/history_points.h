// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/monitor/history/summary_query.h"
#include "daemon/monitor/history/weather_effects.h"

namespace framewatch::daemon {

/// The first moment of a history, and the end of its newest summary.
struct HistoryExtent {
  std::int64_t first_us, end_us;
};

/// Returns nullopt for a history without summaries.
std::optional<HistoryExtent> history_extent(SummaryQuery& summaries);

/// A span of a history as some hundreds of points: one for each step of the span.
struct HistorySpan {
  static constexpr std::size_t kMostPoints = 750;
  static constexpr std::int64_t kMostPeriods =
      400'000;  ///< read for one element: 45 years of hours

  std::int64_t from_us = 0, to_us = 0;
  std::int64_t period_s = 0;  ///< of the summaries to read; 0: the span has no summaries
  std::int64_t step_s = 0;    ///< at least period_s
  std::int64_t end_us = 0;    ///< of the newest summary, or to_us if that is earlier

  /// Returns the number of steps, which begin at multiples of step_s since 1970.
  std::size_t points() const;
  std::int64_t start_us(std::size_t point) const;
  /// Returns the number of the step of a time in the span.
  std::size_t at(std::int64_t time_us) const;
};

/// Returns the step that a span of this length has at least: a minute, ten minutes, an hour, a day,
/// a week, four weeks or 52 weeks, so that there are at most kMostPoints.
std::int64_t least_step_s(std::int64_t from_us, std::int64_t to_us);

/// Chooses the longest summaries that the step allows and that the span has; if it has only longer
/// ones, the step is theirs. Returns nullopt, with the reason in `problem`, if more than
/// kMostPeriods would have to be read.
std::optional<HistorySpan> choose_span(SummaryQuery& summaries, std::int64_t from_us,
                                       std::int64_t to_us, std::string& problem);

/// One element over a span; each list has a value for every point, NaN for none.
struct ElementPoints {
  std::vector<double> q1, median, q3;  ///< medians of those of the summaries in a step
  std::vector<double> covered;  ///< share of the step's time in which windows show the element
};

/// Reads an element. Holds the summaries of one step at a time.
ElementPoints element_points(const SummaryParameter& parameter, SummaryQuery& summaries,
                             const HistorySpan& span);

/// Returns what each median would be in the mean weather of all days; NaN: not known.
std::vector<double> corrected_points(const std::string& element, const ElementPoints& points,
                                     const HistorySpan& span, const WeatherEffects& effects);

/// A covariate over a span, in its unit; NaN for points without a reading.
struct WeatherPoints {
  std::string name;
  std::vector<double> mean, min, max;
};

/// Reads the weather that the history keeps of the span, in hours. In spans with shorter steps, the
/// value of an hour stands for its steps.
std::vector<WeatherPoints> weather_points(SummaryQuery& summaries, const HistorySpan& span);

}  // namespace framewatch::daemon
