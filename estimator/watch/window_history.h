// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "estimator/motion/sample.h"

namespace framewatch::estimator {

/// Keeps every parameter's deviation from the baseline in the newest kMax windows of one length,
/// sorted by time whatever the order of arrival. A place is an index into them, 0 the oldest.
class WindowHistory {
 public:
  static constexpr std::size_t kMax = 40;

  explicit WindowHistory(std::size_t parameters);

  /// A parameter in a window, relative to the baseline. std_error: > 0, independent between windows
  /// that do not overlap. common_error: >= 0, the same in all windows.
  struct Value {
    double off, std_error, common_error;
  };

  /// Adds a window without values and returns its place. Drops the oldest window when there are
  /// kMax. Returns kMax and adds nothing when this window is older than kMax others.
  std::size_t add(Time start, Time end);
  void put(std::size_t place, std::size_t parameter, const Value& value);
  void clear() { count_ = 0; }

  std::size_t size() const { return count_; }
  Time start(std::size_t place) const { return start_[place]; }
  Time end(std::size_t place) const { return end_[place]; }
  bool has(std::size_t place, std::size_t parameter) const {
    return std_error_[place * parameters_ + parameter] > 0;
  }
  Value value(std::size_t place, std::size_t parameter) const {
    const std::size_t i = place * parameters_ + parameter;
    return {off_[i], std_error_[i], common_error_[i]};
  }
  /// Returns the place of the first window that begins at `from` or later and has the parameter;
  /// size() if there is no such window.
  std::size_t first(std::size_t parameter, Time from) const;

  void archive(auto& a) {
    a.within(count_, 0, static_cast<double>(kMax));
    a(start_, end_);
    a.finite(off_, std_error_, common_error_);
  }

 private:
  void move(std::size_t from, std::size_t to);

  std::size_t parameters_, count_ = 0;
  std::vector<Time> start_, end_;
  std::vector<float> off_, std_error_, common_error_;  ///< kMax x parameters; error 0: no value
};

/// The time at which a parameter changed.
struct ChangeTime {
  Time best{};                ///< the most likely instant
  Time earliest{}, latest{};  ///< the 95 % interval
};

/// Finds the instant between `from` and `to` that best divides a parameter's windows in two.
/// Windows wholly before it have one value and windows wholly behind it another. A window across it
/// has the share of the change that lies behind the instant (docs/equations.md (42)). Windows that
/// overlap share a likelihood. histories: one for each length of window. before_error: > 0,
/// standard error of the value before, relative to the baseline. step: between the instants that
/// are tried. Returns nullopt when no window shows a change.
std::optional<ChangeTime> time_of_change(std::span<const WindowHistory* const> histories,
                                         std::size_t parameter, double before_error, Time from,
                                         Time to, SensorClock::duration step);

}  // namespace framewatch::estimator
