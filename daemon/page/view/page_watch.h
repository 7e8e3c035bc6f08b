#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <framewatch/event_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/config/config.h"
#include "estimator/watch/watch.h"

namespace framewatch::daemon {

/// Theta order. Estimates of parameters with other names are not watched.
std::vector<std::string> parameter_names(const Config& config);
/// What Watch and the motion of floors without sensors read of an estimate.
estimator::WindowEstimate decoded_estimate(int window, const window_estimate_t& message);

/// Watches the stiffnesses of published estimates for changes where nobody else does: without
/// [watch] in the configuration. The test is the estimator's (estimator::Watch), in the main and
/// the other windows at once, against a baseline that it learns from the first kBaseline_s of
/// separate windows. Sensor time only.
class PageWatch {
 public:
  static constexpr double kBaseline_s = 8;
  static constexpr double kSmallestFrame_ratio = 0.05, kSmallestPanel_ratio = 0.2;

  /// first_id: of the events.
  PageWatch(const Config& config, std::int64_t first_id);

  /// Events that this estimate gives reason for. window: as WindowEstimate::window, not the long
  /// one.
  std::vector<event_t> observe(int window, const window_estimate_t& estimate);
  /// Learns the baseline anew. Clears no event.
  void renew();
  /// Theta order, SI; NaN for parameters that are not watched and while it is not known.
  std::vector<double> baseline() const;
  /// Whether changes of the parameter are looked for.
  bool watched(std::size_t parameter) const {
    return parameter < static_cast<std::size_t>(watch_.parameters()) && watch_.watched(parameter);
  }

 private:
  event_t event(const estimator::Alarm& alarm) const;

  estimator::ParameterTable table_;
  std::vector<double> windows_s_;
  estimator::Watch watch_;
  std::int64_t first_id_, last_alarm_ = 0;
};

}  // namespace framewatch::daemon
