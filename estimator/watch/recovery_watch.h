#pragma once

#include <cstddef>
#include <vector>

#include "estimator/watch/recovery.h"
#include "estimator/watch/strong_motion.h"
#include "estimator/watch/watch.h"

namespace framewatch::estimator {

/// Follows how every watched element recovers after strong motion, in ordinary and in long windows.
/// An aftershock of less than kAftershock of the motion before, within a day, does not begin the
/// law anew: its windows are left out.
class RecoveryWatch {
 public:
  static constexpr double kAftershock = 0.5;

  RecoveryWatch(const Watch& watch, const WatchOptions& options);

  /// A window estimate, after the watch has had it. long_window: it is of weak motion.
  void push(const WindowEstimate& estimate, bool long_window, const Watch& watch,
            const StrongMotion& strong);
  /// Elements whose finding is to be renewed now: Recovery::kRenew_s. Valid until the next push().
  const std::vector<int>& due() const { return due_; }
  /// Null while the element has no law (no strong motion, or no window since), and when there is no
  /// such element.
  const Recovery* of(int parameter) const;

  template <typename Archive>
  void archive(Archive& a) {
    a(recoveries_, usual_m_, ended_);
    a.finite(peak_mps2_);
  }

 private:
  void begin(Time ended);
  void take(std::size_t parameter, const WindowEstimate& estimate, const Watch& watch);
  void take_long(std::size_t parameter, const WindowEstimate& estimate, const Watch& watch);

  std::vector<Recovery> recoveries_;  ///< theta order
  std::vector<double> usual_m_;       ///< amplitude of the windows before the motion; 0: none
  Time ended_{};                      ///< of the motion that the laws begin with
  double peak_mps2_ = 0;              ///< of it; 0: none
  std::vector<int> due_;
};

}  // namespace framewatch::estimator
