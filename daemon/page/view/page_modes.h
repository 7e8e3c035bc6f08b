// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/page/view/page_history.h"
#include "estimator/modes/natural_modes.h"

namespace framewatch::daemon {

/// Most modes that the page lists.
inline constexpr int kMostPageModes = 8;
/// Most degrees of freedom of a building whose modes the page shows: its server computes them
/// between two messages.
inline constexpr int kMostPageFreedoms = 120;

/// The lowest natural modes of the identified building, for the page.
struct PageModes {
  std::vector<estimator::NaturalMode> modes;
  std::string why;             ///< why there are no modes; empty: there are
  std::string why_no_damping;  ///< why the modes have no damping ratio; empty: they have one
  std::int64_t oldest_us = 0;  ///< end of the window that the oldest value is from, sensor time
};

/// Returns the modes of the newest value of every parameter. `newest` is in theta order. Errors
/// follow from the standard errors of the values, taken as independent. An element that never had a
/// value has the design's value with its usual error (estimator::design_tolerance). Without a
/// design, or if that element is a frame, it is the reason why there are no modes.
PageModes page_modes(const Config& config, const NewestValues& newest);

}  // namespace framewatch::daemon
