#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <framewatch/event_t.hpp>
#include <framewatch/gap_t.hpp>
#include <framewatch/parameter_table_t.hpp>
#include <framewatch/status_t.hpp>
#include <framewatch/watch_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/config.h"
#include "daemon/raised_events.h"
#include "estimator/watch/gap_alarm.h"

namespace framewatch::daemon {

/// Where encoded messages go: LCM, a log. `time_us` is sensor time.
using MessageSink = std::function<void(std::int64_t time_us, const std::string& channel,
                                       const std::vector<std::uint8_t>& bytes)>;

/// What only a live process knows; all zero in replay, so that its output is reproducible.
struct LiveState {
  std::int32_t queue_high_water = 0;
  std::int64_t queue_dropped = 0;
  double latency_s = 0;
};

/// One axis' line of the status message.
struct AxisStatus {
  std::int64_t received = 0, lost = 0, late = 0, repaired = 0, rejected = 0, stuck = 0, clipped = 0;
  double noise_density = std::numeric_limits<double>::quiet_NaN();  ///< m/s^2/sqrt(Hz)
};

struct StatusCounts {
  std::int64_t windows = 0, sample_sets = 0, gaps = 0, rejected_messages = 0;
  std::vector<AxisStatus> axes;  ///< parallel to the configured ones
};

/// Turns what the estimator says into the messages of lcmtypes/. No wall clock: the same estimates
/// give the same bytes.
class Publisher {
 public:
  /// `config` must outlive this. Without a sink nothing is encoded.
  Publisher(const Config& config, MessageSink sink);

  void parameters(std::int64_t time_us, const Pipeline& pipeline);
  /// Boxplot statistics go with every LcmSettings::boxplot_every-th window.
  void estimate(const WindowEstimate& estimate);
  /// One of the other windows, on its own channel.
  void other(const WindowEstimate& estimate);
  /// News of an alarm; lasting until it is cleared.
  void alarm(const Alarm& alarm, const ParameterTable& table);
  void event(const event_t& event);
  /// What changes are judged against.
  void watch(std::int64_t time_us, const Watch& watch);
  void gap(const GapWindow& window);
  void gap_news(const GapNews& news);
  /// Clears what is raised of a kind: nobody looks for it any more.
  void withdraw(const std::string& kind);
  const RaisedEvents& raised() const { return raised_; }
  RaisedEvents& raised() { return raised_; }
  void status(std::int64_t time_us, const StatusCounts& counts, const LiveState& live);

  /// State (estimator/state/archive.h): the events that are raised.
  template <typename Archive>
  void archive(Archive& a) {
    a(raised_);
  }

 private:
  void fill_values(const WindowEstimate& estimate);
  template <typename MessageType>
  void send(std::int64_t time_us, const std::string& channel, const MessageType& message);

  const Config& config_;
  MessageSink sink_;
  std::string parameters_channel_, estimate_channel_, status_channel_, event_channel_, gap_channel_,
      watch_channel_;
  std::vector<std::string> other_channels_;
  framewatch::parameter_table_t parameters_{};
  framewatch::window_estimate_t estimate_{};
  framewatch::status_t status_{};
  framewatch::gap_t gap_{};
  framewatch::watch_t watch_{};
  std::vector<std::uint8_t> bytes_;
  RaisedEvents raised_;
};

}  // namespace framewatch::daemon
