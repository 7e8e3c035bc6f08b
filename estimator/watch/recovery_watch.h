// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "estimator/motion/sample.h"
#include "estimator/structure/sensors.h"
#include "estimator/watch/recovery.h"
#include "estimator/watch/watch.h"

namespace framewatch::estimator {

/// Finds strong motion: a horizontal channel of the base is further than the trigger from its mean.
/// A base without sensors is replaced by all horizontal channels. Motions less than kCalm_s apart
/// count as one.
class StrongMotion {
 public:
  static constexpr double kTrigger_mps2 = 0.1, kCalm_s = 20;

  StrongMotion(const std::vector<SensorAxis>& axes, double rate_hz);

  /// Takes one calibrated instant.
  void push(const SampleSet& set);
  bool any() const { return any_; }
  /// Precondition of the next two: any(). last(): the last strong instant so far. peak_mps2(): the
  /// largest distance from the mean since the motion began, m/s^2.
  Time last() const { return last_; }
  double peak_mps2() const { return peak_; }

  void archive(auto& a) {
    a(any_, last_);
    a.finite(peak_, mean_, seen_);
  }

 private:
  std::vector<std::size_t> axes_;
  double mean_step_;  ///< of the mean's filter, per instant
  bool any_ = false;
  Time last_{};
  double peak_ = 0;
  std::vector<double> mean_, seen_;
};

/// Follows how every watched element recovers after strong motion, in ordinary and in long windows.
/// An aftershock within a day that has less than kAftershock of the peak of the motion before does
/// not restart the law; its windows are left out.
class RecoveryWatch {
 public:
  static constexpr double kAftershock = 0.5;

  RecoveryWatch(const Watch& watch, const WatchOptions& options);

  /// Takes a window estimate, after `watch` has taken it. long_window: it is a window of weak
  /// motion.
  void push(const WindowEstimate& estimate, bool long_window, const Watch& watch,
            const StrongMotion& strong);
  /// Returns the elements whose finding must be renewed now (Recovery::kRenew_s). Valid until the
  /// next push().
  const std::vector<int>& due() const { return due_; }
  /// Returns the law of an element; null if there is no such element, no strong motion or no window
  /// since.
  const Recovery* of(int parameter) const;

  void archive(auto& a) {
    a(recoveries_, usual_m_, ended_);
    a.finite(peak_mps2_);
  }

 private:
  void begin(Time ended);
  void take(std::size_t parameter, const WindowEstimate& estimate, const Watch& watch);
  void take_long(std::size_t parameter, const WindowEstimate& estimate, const Watch& watch);

  std::vector<Recovery> recoveries_;  ///< theta order
  std::vector<double> usual_m_;       ///< amplitude of the windows before the motion; 0: not known
  Time ended_{};                      ///< end of the motion that the laws begin with
  double peak_mps2_ = 0;              ///< of that motion; 0: no motion
  std::vector<int> due_;
};

}  // namespace framewatch::estimator
