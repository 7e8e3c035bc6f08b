// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "daemon/monitor/history/history_request.h"
#include "daemon/monitor/history/summary_query.h"
#include "estimator/years/years_watch.h"

namespace framewatch::daemon {

/// One day of a stiffness: its mean, the quartiles of its hours, and the share of windows with a
/// value.
struct DayOfElement {
  estimator::DayMean mean;
  double q1, median, q3;
  double shown;
};

struct ElementDays {
  std::string name;
  std::map<std::int64_t, DayOfElement> days;  ///< by day since 1970, UTC

  /// Returns the median of all days; there must be one.
  double usual() const;
  /// Returns the value of a day; NaN: none.
  estimator::DayValue value(std::int64_t day) const;
};

/// Returns the day since 1970, UTC.
std::int64_t floor_day(std::int64_t time_us);
/// The quantities that are watched for years: the stiffness of frames (kx_, ky_) for losses, their
/// damping (cx_, cy_) for growth.
enum class Quantity { stiffness, damping };

/// Returns true for this quantity of a frame.
bool is_of_frame(Quantity quantity, const std::string& parameter);
/// Returns a day's value as a YearsWatch of this quantity takes it.
estimator::DayValue watched(Quantity quantity, const estimator::DayValue& value);
/// Returns what a finding of that watch says of the quantity.
estimator::YearsWatch::Finding in_quantity(Quantity quantity,
                                           const estimator::YearsWatch::Finding& finding);

/// Reads the days of a parameter from summaries of this length that start in [from_us, to_us).
/// window_s: length of the windows.
ElementDays element_days(const SummaryParameter& parameter, SummaryQuery& summaries,
                         std::int64_t period_s, double window_s, std::int64_t from_us,
                         std::int64_t to_us);

/// Reads a quantity of the frames of a request day by day. Elements without any value are left
/// out.
std::vector<ElementDays> read_days(const HistoryRequest& request, Quantity quantity,
                                   SummaryQuery& summaries);

/// Returns "2026-11-28" for a day since 1970.
std::string day_text(std::int64_t day);
/// Returns "1 day" or "12 days".
std::string days_text(int days);

}  // namespace framewatch::daemon
