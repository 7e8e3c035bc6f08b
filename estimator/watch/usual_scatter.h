#pragma once

#include <cstdint>

#include "estimator/motion/sample.h"

namespace framewatch::estimator {

/// By how much the windows of an intact element scatter more than their standard errors say: from
/// one window to the next, which a mean makes smaller, and slowly, which it does not. Both from
/// windows of one length that do not overlap (docs/equations.md (43)).
class UsualScatter {
 public:
  static constexpr double kMinExcess = 0.35;

  /// Deviation from the baseline, relative, and its standard error > 0. A window that overlaps the
  /// one before is left out.
  void push(Time start, Time end, double off, double std_error);

  /// Variance from window to window over what the errors say, >= kMinExcess.
  double excess() const { return excess_ > kMinExcess ? excess_ : kMinExcess; }
  /// Standard deviation of slow changes, relative to the baseline, >= 0.
  double slow() const;

  template <typename Archive>
  void archive(Archive& a) {
    a(until_);
    a.within(group_, 0, kGroup);
    a.within(windows_, 0, a.kMaxCount);
    a.within(groups_, 0, a.kMaxCount);
    a.finite(last_off_, last_error_, excess_, weight_, sum_, slow_, chance_);
  }

 private:
  static constexpr int kGroup = 6;  ///< windows whose mean shows slow changes

  Time until_{};
  std::int64_t windows_ = 0, groups_ = 0;
  int group_ = 0;
  double last_off_ = 0, last_error_ = 0;
  double excess_ = 1;
  double weight_ = 0, sum_ = 0;  ///< of the group so far
  double chance_ = 0;            ///< variance of a group's mean by chance
  double slow_ = 0;              ///< variance beyond chance
};

}  // namespace framewatch::estimator
