// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "estimator/identify/estimate/estimate.h"

namespace framewatch::estimator {

/// The limits by which one parameter is watched for changes.
struct Watched {
  double least_change = 0;  ///< least relevant change, relative; 0: not watched
  double most_bias = 1;     ///< share of prior and noise above which a value does not count
  double tolerance = 0;     ///< lasting deviation, relative, that does not count as a change

  /// Returns true if baselines learn from parameter `p` of this window and detectors judge it. A
  /// value biased by prior and noise does not count: all windows share the bias, so no mean removes
  /// it.
  bool counts(const WindowEstimate& e, std::size_t p) const {
    return e.reason[p] == Observability::observable && e.std_error[p] > 0 &&
           e.prior_share[p] + e.noise_share[p] <= most_bias;
  }
};

/// Selects the windows to learn from: valid ones that do not overlap, so that their errors are
/// nearly independent.
class SeparateWindows {
 public:
  /// Returns true if this window is selected; it then counts.
  bool take(const WindowEstimate& e) {
    if (e.status != WindowStatus::valid || (count_ > 0 && e.start <= end_)) return false;
    end_ = e.end;
    ++count_;
    seconds_ += length_s(e);
    return true;
  }
  static double length_s(const WindowEstimate& e) { return seconds_of(e.end - e.start); }
  /// Returns the total length of the selected windows, s.
  double seconds() const { return seconds_; }
  /// Returns true if `count` > 0 windows are at least half of the selected ones.
  bool most(int count) const { return count > 0 && 2 * count >= count_; }

  void archive(auto& a) {
    a.within(count_, 0, a.kMaxCount);
    a.within(seconds_, 0, a.kMaxCount);
    a(end_);
  }

 private:
  int count_ = 0;
  double seconds_ = 0;
  Time end_{};
};

}  // namespace framewatch::estimator
