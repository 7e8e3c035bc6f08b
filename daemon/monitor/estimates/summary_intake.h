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
#include <framewatch/window_estimate_t.hpp>

namespace framewatch::daemon {

/// One parameter in the windows that ended in a period, or in a part of it.
struct ParameterData {
  std::int64_t observable = 0;
  double sum = 0, error_squares = 0;  ///< of values and of their standard errors
  double min = std::numeric_limits<double>::infinity();
  double max = -std::numeric_limits<double>::infinity();
  std::vector<double> box;  ///< values for the boxplot, a tenth of a window's length apart
};

/// One channel in the same time.
struct ChannelData {
  enum Count { received, lost, late, repaired, rejected, stuck, clipped, kCounts };
  std::array<std::int64_t, kCounts> counts{};
  double noise = std::numeric_limits<double>::quiet_NaN();  ///< m/s^2/sqrt(Hz), the newest
};

/// What is to go into the database of one of the shortest periods, in one piece or in several.
struct PeriodData {
  std::int64_t start_us = 0;
  /// The newest of them ended at last_us. 0 windows with parameters: values that came late, of
  /// windows that an earlier piece counted without a value.
  std::int64_t windows = 0, last_us = INT64_MIN;
  std::vector<ParameterData> parameters;
  std::vector<ChannelData> channels;
};

/// Collects the messages of a running estimation by periods of `period_us`, of sensor time.
class PeriodCollector {
 public:
  explicit PeriodCollector(std::int64_t period_us) : period_us_(period_us) {}

  /// Whether the message belongs to another period, or to other parameters, than those being
  /// collected: then take() has to be called first.
  bool ends_before(const window_estimate_t& estimate) const;
  bool ends_before(const status_t& status) const;
  bool ends_before(const parameter_table_t& table) const;

  /// Windows of that period that ended until `last_us` are in the database already, from an earlier
  /// run: they are not counted again.
  void taken(std::int64_t start_us, std::int64_t last_us);
  /// Estimates that come before their table, or were stored already, are left out.
  void add(const window_estimate_t& estimate);
  /// A window that was counted before, without values, and has them now.
  void add_late(const window_estimate_t& estimate);
  void add(const status_t& status);
  void add(const parameter_table_t& table);

  bool empty() const { return data_.windows == 0 && data_.channels.empty(); }
  /// Returns what was collected and begins anew.
  PeriodData take();
  /// Returns the values that add_late() got for periods that take() had returned before, by period,
  /// and forgets them.
  std::vector<PeriodData> take_late();

  const parameter_table_t& parameters() const { return table_; }
  const std::vector<std::string>& channels() const { return status_.name; }

 private:
  std::int64_t slot(std::int64_t time_us) const;
  void add_values(const window_estimate_t& estimate, PeriodData& to);

  std::int64_t period_us_;
  parameter_table_t table_{};
  status_t status_{};  ///< the newest
  std::int64_t box_slot_ = INT64_MIN;
  std::map<std::int64_t, std::int64_t> taken_;  ///< newest end by start of the period
  PeriodData data_;
  std::map<std::int64_t, PeriodData> late_;  ///< by start of the period
};

/// What is stored at once.
struct SummaryBatch {
  parameter_table_t parameters{};     ///< of every period in it
  std::vector<std::string> channels;  ///< likewise
  std::vector<PeriodData> periods;
  std::vector<event_t> events;
  std::vector<acknowledged_t> acknowledged;

  bool empty() const { return periods.empty() && events.empty() && acknowledged.empty(); }
};

/// The messages of an estimation, collected into what a SummaryStore takes.
class SummaryIntake {
 public:
  enum class Kind { estimate, late, table, status, event, acknowledged };
  struct Taken {
    bool period = false;  ///< a period has ended, before the message
    bool news = false;    ///< an event or an acknowledgement came
  };

  /// `prefix`: of the LCM channels. `before_other_names`: called when parameters of other names
  /// come: what waits is to be stored, for the periods that are left then are dropped.
  SummaryIntake(const std::string& prefix, std::int64_t shortest_s,
                std::function<void()> before_other_names);

  /// Empty: of no use here.
  std::optional<Kind> kind_of(const std::string& channel) const;
  /// What does not decode is left alone.
  Taken take(Kind kind, std::span<const std::uint8_t> bytes);
  /// Moves the period that is being collected to the batch, and values that came late for earlier
  /// periods. Returns false when there was nothing to move.
  bool end_period();

  SummaryBatch& batch() { return batch_; }
  PeriodCollector& collector() { return collector_; }
  std::int64_t newest_us() const { return newest_us_; }  ///< end of a window; INT64_MIN: none

 private:
  const std::string estimate_, late_, table_, status_, event_, acknowledged_;  ///< channels
  std::function<void()> before_other_names_;
  PeriodCollector collector_;
  SummaryBatch batch_;
  std::int64_t newest_us_ = INT64_MIN;
};

}  // namespace framewatch::daemon
