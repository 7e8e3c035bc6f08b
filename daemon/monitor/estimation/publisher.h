// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <framewatch/event_t.hpp>
#include <framewatch/gap_t.hpp>
#include <framewatch/model_fit_t.hpp>
#include <framewatch/parameter_table_t.hpp>
#include <framewatch/status_t.hpp>
#include <framewatch/watch_t.hpp>
#include <framewatch/weather_status_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/config/config.h"
#include "estimator/gap/gap.h"

namespace framewatch::daemon {

/// Receives encoded messages, for LCM or a log. `time_us` is sensor time.
using MessageSink = std::function<void(std::int64_t time_us, const std::string& channel,
                                       const std::vector<std::uint8_t>& bytes)>;

/// Returns the LCM channels of the estimates by WindowEstimate::window: the main window, the other
/// windows and, if configured, the long one.
std::vector<std::string> estimate_channels(const Config& config);

/// Suffix of a channel for its late estimates (WindowEstimate::late).
inline constexpr const char* kLate = "_LATE";

/// Counters of a live process. All are zero in a replay, so that its output is reproducible.
struct LiveState {
  std::int32_t queue_high_water = 0;
  std::int64_t queue_dropped = 0;
  double latency_s = 0;
};

/// Turns results of the estimator into the messages of lcmtypes/ and sends them. Uses no clock: the
/// same estimates give the same bytes.
class Publisher {
 public:
  /// `config` must outlive this. Without a sink nothing is encoded.
  Publisher(const Config& config, MessageSink sink);

  void parameters(std::int64_t time_us, const estimator::Pipeline& pipeline);
  /// Publishes an estimate of the main window, every LcmSettings::boxplot_every-th one with boxplot
  /// statistics.
  void estimate(const estimator::WindowEstimate& estimate);
  /// Publishes an estimate of another window on its own channel.
  void other(const estimator::WindowEstimate& estimate);
  /// Publishes a late estimate (WindowEstimate::late) on its window's channel plus _LATE, so that
  /// readers of the main channel get windows in order.
  void late(const estimator::WindowEstimate& estimate);
  void event(const event_t& event);
  /// Publishes the baselines with which changes are compared.
  void watch(std::int64_t time_us, const estimator::Watch& watch);
  void weather(const weather_status_t& weather);
  void gap(const estimator::GapWindow& window);
  void model(const estimator::ModelFit& fit);
  /// Publishes the counters of `status`, which are by axis. Adds the names of the axes, the
  /// configuration and the version.
  void status(status_t status);

 private:
  void fill_values(const estimator::WindowEstimate& estimate);
  template <typename MessageType>
  void send(std::int64_t time_us, const std::string& channel, const MessageType& message);

  const Config& config_;
  MessageSink sink_;
  const std::vector<std::string> estimate_channels_;  ///< by WindowEstimate::window
  framewatch::window_estimate_t estimate_{};
  framewatch::model_fit_t model_{};
  std::vector<std::uint8_t> bytes_;
};

}  // namespace framewatch::daemon
