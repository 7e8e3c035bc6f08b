#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <framewatch/acknowledged_t.hpp>
#include <framewatch/event_t.hpp>
#include <framewatch/parameter_table_t.hpp>

#include "daemon/monitor/estimates/period_data.h"

namespace framewatch::daemon {

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
