// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <framewatch/acknowledged_t.hpp>
#include <framewatch/event_t.hpp>
#include <framewatch/parameter_table_t.hpp>
#include <framewatch/status_t.hpp>
#include <framewatch/weather_status_t.hpp>
#include <framewatch/window_estimate_t.hpp>

namespace framewatch::daemon {

/// Returns the largest multiple of `step_us` that is not larger than `time_us`.
std::int64_t floor_to(std::int64_t time_us, std::int64_t step_us);

/// One parameter in the windows that ended in a period or in a part of it.
struct ParameterData {
  std::int64_t observable = 0;
  double sum = 0,
         error_squares = 0;  ///< of the values, and of the squares of their standard errors
  double min = std::numeric_limits<double>::infinity();
  double max = -std::numeric_limits<double>::infinity();
  std::vector<double> box;  ///< values for the boxplot, a tenth of a window's length apart
};

/// One channel in a period or in a part of it.
struct ChannelData {
  enum Count { received, lost, late, repaired, rejected, stuck, clipped, kCounts };
  std::array<std::int64_t, kCounts> counts{};
  double noise = std::numeric_limits<double>::quiet_NaN();  ///< the newest value, m/s^2/sqrt(Hz)
};

/// The contribution to one of the shortest periods in the database. A period may come in several
/// pieces.
struct PeriodData {
  std::int64_t start_us = 0;
  bool whole = false;  ///< no other piece of the period comes
  /// The newest window ended at last_us. 0 windows with parameters: late values of windows that an
  /// earlier piece counted without a value.
  std::int64_t windows = 0, last_us = INT64_MIN;
  std::vector<ParameterData> parameters;
  std::vector<ChannelData> channels;
};

/// Collects the messages of a running estimation by periods of `period_us` of sensor time.
class PeriodCollector {
 public:
  explicit PeriodCollector(std::int64_t period_us) : period_us_(period_us) {}

  /// Returns true if the message belongs to another period, or has other parameters, than those
  /// being collected. Call take() before you add it.
  bool ends_before(const window_estimate_t& estimate) const;
  bool ends_before(const status_t& status) const;
  bool ends_before(const parameter_table_t& table) const;

  /// Tells that the database already has the windows of that period that ended until `last_us`,
  /// from an earlier run. They are not counted again.
  void taken(std::int64_t start_us, std::int64_t last_us);
  /// Adds an estimate. Ignores one that comes before its table or that is stored already.
  void add(const window_estimate_t& estimate);
  /// Adds the values of a window that was counted without values before.
  void add_late(const window_estimate_t& estimate);
  /// Adds the counters of a status, as the difference to the one before.
  void add(const status_t& status);
  /// Sets the table that the next estimates refer to.
  void add(const parameter_table_t& table);

  bool empty() const { return data_.windows == 0 && data_.channels.empty(); }
  /// Returns the collected data and starts a new piece.
  PeriodData take();
  /// Returns, by period, the values that add_late() got for periods that take() had already
  /// returned, and forgets them.
  std::vector<PeriodData> take_late();

  const parameter_table_t& parameters() const { return table_; }
  const std::vector<std::string>& channels() const { return status_.name; }

 private:
  std::int64_t slot(std::int64_t time_us) const;
  void add_values(const window_estimate_t& estimate, PeriodData& to);

  std::int64_t period_us_;
  parameter_table_t table_{};
  status_t status_{};  ///< the newest one
  std::int64_t box_slot_ = INT64_MIN;
  std::map<std::int64_t, std::int64_t> taken_;  ///< newest end, by start of the period
  PeriodData data_;
  std::map<std::int64_t, PeriodData> late_;  ///< by start of the period
};

/// The mean of readings of a covariate that came within a second or so.
struct WeatherReading {
  std::string name;
  std::int64_t time_us;
  double value;
};

/// The data that one transaction stores.
struct SummaryBatch {
  parameter_table_t parameters{};     ///< of all its periods
  std::vector<std::string> channels;  ///< of all its periods
  std::vector<PeriodData> periods;
  std::vector<event_t> events;
  std::vector<acknowledged_t> acknowledged;
  std::vector<WeatherReading> weather;  ///< in order of time

  bool empty() const {
    return periods.empty() && events.empty() && acknowledged.empty() && weather.empty();
  }
};

/// Collects the messages of an estimation into the batches that a SummaryStore takes.
class SummaryIntake {
 public:
  enum class Kind { estimate, late, table, status, event, acknowledged, weather };
  struct Taken {
    bool period = false;  ///< the message ended a period
    bool news = false;    ///< it was an event or an acknowledgement
  };

  /// `prefix` is that of the LCM channels. Calls `before_other_names` when parameters with other
  /// names come: store the batch then, because periods that still wait are dropped.
  SummaryIntake(const std::string& prefix, std::int64_t shortest_s,
                std::function<void()> before_other_names);

  /// Returns nullopt if no message on that channel is used.
  std::optional<Kind> kind_of(const std::string& channel) const;
  /// Takes a message. Ignores one that does not decode.
  Taken take(Kind kind, std::span<const std::uint8_t> bytes);
  /// Moves the period being collected, and late values of earlier periods, to the batch. Returns
  /// false if there was nothing to move.
  bool end_period();

  SummaryBatch& batch() { return batch_; }
  PeriodCollector& collector() { return collector_; }
  /// Returns the end of the newest window; INT64_MIN: none.
  std::int64_t newest_us() const { return newest_us_; }

 private:
  const std::map<std::string, Kind> kinds_;  ///< by channel
  std::function<void()> before_other_names_;
  PeriodCollector collector_;
  SummaryBatch batch_;
  std::int64_t newest_us_ = INT64_MIN;
};

}  // namespace framewatch::daemon
