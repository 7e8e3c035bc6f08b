#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <framewatch/event_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/config/config.h"
#include "estimator/motion/sample.h"

namespace framewatch::daemon {

/// What `framewatch run` has stored ([history]) of what the page shows, for a page whose server was
/// started anew.
struct StoredHistory {
  static constexpr std::size_t kMaxEvents = 200;
  static constexpr std::size_t kMaxSamples = 2'000'000;  ///< of many sensors fewer minutes

  /// Of every period of the last minutes, and of older ones that have the newest value of a
  /// parameter: its means as the estimate of a window that ends with it, in order of time.
  std::vector<window_estimate_t> estimates;
  std::vector<event_t> events;                  ///< in order of time
  std::vector<estimator::AccelSample> samples;  ///< of the last minutes, before calibration
};

/// Of a configuration with [history]. What cannot be read is left out, and said in `notes`.
StoredHistory stored_history(const Config& config, std::vector<std::string>& notes);

}  // namespace framewatch::daemon
