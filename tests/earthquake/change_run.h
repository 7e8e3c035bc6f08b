// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "tests/earthquake/announcements.h"
#include "tests/earthquake/change_case.h"

namespace framewatch::earthquake {

struct ChangeRunOptions {
  double hop_s = 0.01;        ///< between windows
  double noise_ratio = 0.01;  ///< of each channel, over the rms of its motion under level 1
  double learn_s = 80;        ///< [watch] learn_s: four of the five levels before the earthquake
};

/// The statements of the program in a case.
struct ChangeRun {
  std::vector<Announcement> said;
  std::vector<bool> watched;  ///< by parameter: true if it had a baseline when the earthquake began
  std::vector<std::string> names;  ///< of all parameters
  std::vector<std::string>
      without_baseline;  ///< parameters that should be watched but had no baseline then
};

ChangeRun run_change(const ChangeCase& of, const ChangeRunOptions& options = {});

}  // namespace framewatch::earthquake
