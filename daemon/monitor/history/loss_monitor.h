// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include <framewatch/event_t.hpp>

#include "daemon/config/config.h"
#include "daemon/monitor/events/change_words.h"
#include "daemon/monitor/events/raised_events.h"
#include "daemon/monitor/history/loss_follower.h"

namespace framewatch::daemon {

/// Returns the event of a lasting loss of stiffness, an alarm, or growth of damping, a warning. Its
/// id and times follow from the finding.
event_t loss_event(Quantity quantity, const LossFollower::Loss& loss,
                   const estimator::LifeBudget& budget, const FrameLabels& labels);

/// Looks once a day of sensor time for lasting losses, and growths of damping, in the daily means
/// of a history, in a thread. Nothing is lost by a restart: it begins with the first day of the
/// history. A loss that an event in the history tells already is not told again.
class LossMonitor {
 public:
  /// Sensor time after the end of a day until the history has it whole.
  static constexpr std::int64_t kMargin_us = 3'600'000'000;
  /// Two findings about one place that begin within this time are one loss.
  static constexpr std::int64_t kSame_d = 45;

  /// `config`, which has [history] and [watch], must outlive this.
  explicit LossMonitor(const Config& config);

  struct News {
    std::vector<event_t> events;  ///< of new losses
    RaisedEvents before;          ///< losses that the history tells already, with acknowledgements
    std::string problem;          ///< why the history cannot be read; empty if it can
  };
  /// Returns what has become known since the last call. stored_us: end of the newest window in the
  /// history.
  News update(std::int64_t stored_us);

 private:
  void work(const std::stop_token& stop);
  void look(std::int64_t to_day, const std::stop_token& stop, News& news);
  void put(News news);
  void read_known(SummaryQuery& summaries, News& news);
  bool is_known(const event_t& event) const;

  const Config& config_;
  const FrameLabels labels_;

  // Used only by the thread.
  std::array<LossFollower, 2> followers_;  ///< by Quantity
  std::vector<event_t> known_;
  bool read_known_ = false;

  std::mutex mutex_;  ///< guards the members below
  std::condition_variable_any wake_;
  std::optional<std::int64_t> wanted_day_;
  News news_;
  std::int64_t asked_day_ = INT64_MIN;  ///< used only by the caller of update()
  std::jthread thread_;                 ///< last, because it uses the members above
};

}  // namespace framewatch::daemon
