// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/base/record_file_arguments.h"

namespace framewatch::daemon {

struct RefineArguments {
  std::string config;
  std::vector<std::string> inputs;  ///< LCM event logs and record files, in order of time
  double from_s = 0;                ///< since the first sample
  double to_s = -1;                 ///< since the first sample; negative: one window after from_s
  bool prior = true;
  bool json = false;
  RecordFileArguments record = {};  ///< options that record files do not state themselves
};

/// Runs `framewatch refine`. Returns the exit code: 0 refined, 1 not refined (the printed status
/// gives the reason), 2 bad usage or input.
int refine(const RefineArguments& arguments);

}  // namespace framewatch::daemon
