// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <framewatch/event_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/config/config.h"
#include "estimator/motion/sample.h"

namespace framewatch::daemon {

/// The part of the history ([history]) that a page shows after its server restarts.
struct StoredHistory {
  static constexpr std::size_t kMaxEvents = 200;
  static constexpr std::size_t kMaxSamples = 2'000'000;  ///< with many sensors: fewer minutes

  /// One estimate for each period of the last minutes and each older period that has the newest
  /// value of a parameter: its means, as a window that ends with it. In order of time.
  std::vector<window_estimate_t> estimates;
  std::vector<event_t> events;                  ///< in order of time
  std::vector<estimator::AccelSample> samples;  ///< last minutes, before calibration
};

/// Reads the history of a configuration with [history]. Leaves out what cannot be read and adds the
/// reason to `notes`.
StoredHistory stored_history(const Config& config, std::vector<std::string>& notes);

}  // namespace framewatch::daemon
