#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "estimator/watch/window_history.h"

namespace framewatch::estimator {

/// When a parameter changed.
struct ChangeTime {
  Time best{};                ///< the most likely instant
  Time earliest{}, latest{};  ///< of those that are nearly as likely: a 95 % interval
};

/// Divides the windows of a parameter at an instant between `from` and `to`: those wholly before it
/// have one value, those wholly behind it another one, and those across it as much of the change as
/// of their time is behind it (docs/equations.md (42)). histories: of windows of different lengths,
/// step: between the instants that are tried. before_error: > 0, what the value before may be off
/// the baseline by. Windows that overlap share a likelihood. Empty when no window shows a change.
std::optional<ChangeTime> time_of_change(std::span<const WindowHistory* const> histories,
                                         std::size_t parameter, double before_error, Time from,
                                         Time to, SensorClock::duration step);

}  // namespace framewatch::estimator
