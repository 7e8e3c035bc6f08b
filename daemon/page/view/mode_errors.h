// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "daemon/page/view/page_modes.h"

namespace framewatch::daemon {

/// Learns from separate windows how far the errors of modes are from those of independent values.
/// The values of one window are correlated, so that a frequency is known better than they say.
class ModeErrors {
 public:
  static constexpr std::size_t kMostWindows = 60;  ///< separate windows that are compared
  static constexpr std::size_t kLeastPairs = 5;    ///< with fewer the values count as independent

  /// window_s: length of the main window.
  explicit ModeErrors(double window_s);

  /// Scales the errors that come from the values of the newest window, and adds those of the other
  /// values. The factor is the median of |difference| / error over successive separate windows,
  /// relative to the one of normal errors.
  void correct(PageModes& modes);

 private:
  struct Window {
    std::vector<double> value, error;  ///< frequency and damping ratio of each mode in turn
  };
  double factor(std::size_t at) const;

  std::int64_t window_us_, last_us_ = 0;
  std::deque<Window> windows_;
};

}  // namespace framewatch::daemon
