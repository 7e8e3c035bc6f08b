// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/page/view/newest_values.h"
#include "estimator/modes/natural_modes.h"

namespace framewatch::daemon {

/// Most modes that the page lists.
inline constexpr int kMostPageModes = 8;
/// Most degrees of freedom of a building whose modes the page shows: its server computes them
/// between two messages.
inline constexpr int kMostPageFreedoms = 120;

/// The lowest natural modes of the identified building, for the page.
struct PageModes {
  /// Their errors follow from the values of the newest window, taken as independent.
  std::vector<estimator::NaturalMode> modes;
  /// Errors of frequency (Hz) and damping ratio of each mode that follow from all other values.
  std::vector<std::array<double, 2>> other_errors;
  std::string why;             ///< why there are no modes; empty: there are
  std::string why_no_damping;  ///< why the modes have no damping ratio; empty: they have one
  /// Ends of the windows of the newest and of the oldest value, sensor time.
  std::int64_t newest_us = 0, oldest_us = 0;
};

/// Returns the modes of the newest value of every parameter. `newest` is in theta order. An
/// element that never had a value has the design's value with its usual error
/// (estimator::design_tolerance). Without a design, or if that element is a frame, it is the reason
/// why there are no modes.
PageModes page_modes(const Config& config, const NewestValues& newest);

}  // namespace framewatch::daemon
