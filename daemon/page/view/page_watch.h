// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <framewatch/event_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/config/config.h"
#include "daemon/monitor/events/change_words.h"
#include "estimator/watch/watch.h"

namespace framewatch::daemon {

/// Returns the names of the parameters in theta order.
std::vector<std::string> parameter_names(const Config& config);
/// Converts the fields of an estimate that estimator::Watch and estimator::StoryResponse read.
estimator::WindowEstimate decoded_estimate(int window, const window_estimate_t& message);

/// Watches the stiffnesses of published estimates for changes when the configuration lacks [watch].
/// Runs estimator::Watch on the main and the other windows, against a baseline learned from the
/// first kBaseline_s of separate windows. Uses sensor time only.
class PageWatch {
 public:
  static constexpr double kBaseline_s = 8;
  static constexpr double kSmallestFrame_ratio = 0.05, kSmallestPanel_ratio = 0.2;

  /// first_id: id of the first event.
  PageWatch(const Config& config, std::int64_t first_id);

  /// Returns the events that this estimate raises, changes or clears. window: as
  /// WindowEstimate::window, but not the long one.
  std::vector<event_t> observe(int window, const window_estimate_t& estimate);
  /// Learns the baseline anew. Does not clear events.
  void renew();
  /// Returns the baseline in theta order, SI units; NaN for parameters that are not watched and
  /// before it is learned.
  std::vector<double> baseline() const;
  /// Returns true when the parameter is watched for changes.
  bool watched(std::size_t parameter) const {
    return parameter < static_cast<std::size_t>(watch_.parameters()) && watch_.watched(parameter);
  }

 private:
  event_t event(const estimator::Alarm& alarm) const;

  estimator::ParameterTable table_;
  FrameLabels labels_;
  std::vector<double> windows_s_;
  estimator::Watch watch_;
  std::int64_t first_id_, last_alarm_ = 0;
};

}  // namespace framewatch::daemon
