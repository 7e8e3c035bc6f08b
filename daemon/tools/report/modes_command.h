// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/base/record_file_arguments.h"

namespace framewatch::daemon {

struct ModesArguments {
  std::string config;
  std::vector<std::string> inputs;  ///< LCM event logs and record files, in order of time
  double from_s = 0;                ///< since the first sample
  double to_s = -1;                 ///< since the first sample; negative: to the end
  bool json = false;
  std::string csv, mat;             ///< files to write; empty: none
  RecordFileArguments record = {};  ///< options that record files do not state themselves
};

/// Runs `framewatch modes`. Returns the exit code: 0 done, 1 neither the model nor the record gives
/// a mode (the printed reasons say why), 2 bad usage or input.
int modes(const ModesArguments& arguments);

}  // namespace framewatch::daemon
