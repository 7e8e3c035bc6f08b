// SPDX-License-Identifier: MIT
#include "daemon/page/view/mode_errors.h"

#include <cmath>

#include "daemon/base/numbers.h"

namespace framewatch::daemon {
namespace {

constexpr double kNormalMedian = 0.6745;  ///< of |x| if x is normal with variance 1

}  // namespace

ModeErrors::ModeErrors(double window_s) : window_us_(static_cast<std::int64_t>(1e6 * window_s)) {}

void ModeErrors::correct(PageModes& modes) {
  if (modes.newest_us < last_us_) windows_.clear();  // another clock
  if (windows_.empty() || modes.newest_us - last_us_ >= window_us_) {
    Window now;
    for (const estimator::NaturalMode& mode : modes.modes) {
      now.value.insert(now.value.end(), {mode.frequency_hz, mode.damping_ratio});
      now.error.insert(now.error.end(), {mode.frequency_error_hz, mode.damping_error});
    }
    windows_.push_back(std::move(now));
    if (windows_.size() > kMostWindows) windows_.pop_front();
    last_us_ = modes.newest_us;
  }
  for (std::size_t i = 0; i < modes.modes.size(); ++i) {
    estimator::NaturalMode& mode = modes.modes[i];
    const auto& [other_hz, other_damping] = modes.other_errors[i];
    mode.frequency_error_hz = std::hypot(factor(2 * i) * mode.frequency_error_hz, other_hz);
    mode.damping_error = std::hypot(factor(2 * i + 1) * mode.damping_error, other_damping);
  }
}

/// Returns the factor of the frequency of mode at/2, or of its damping ratio.
double ModeErrors::factor(std::size_t at) const {
  std::vector<double> scatter;
  for (std::size_t w = 1; w < windows_.size(); ++w) {
    const Window &one = windows_[w - 1], &next = windows_[w];
    if (at >= one.value.size() || at >= next.value.size()) continue;
    scatter.push_back(std::abs(next.value[at] - one.value[at]) /
                      std::hypot(one.error[at], next.error[at]));
  }
  return scatter.size() < kLeastPairs ? 1 : median(std::move(scatter)) / kNormalMedian;
}

}  // namespace framewatch::daemon
