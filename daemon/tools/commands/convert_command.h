// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/base/record_file_arguments.h"

namespace framewatch::daemon {

struct ConvertArguments {
  std::vector<std::string> inputs;  ///< record files, or one LCM event log
  std::string out;                  ///< .lcmlog, .csv or .csv.gz
  RecordFileArguments record;       ///< properties that record files do not state
  std::string
      config;  ///< gives the LCM channel and node of named columns; empty for column numbers
  std::string
      channel;  ///< LCM channel to write or read; empty for ACCEL or the only one of its kind
  bool boxplot = false;
  bool denoise = false;       ///< apply the paper's noise removal to every channel
  std::int64_t start_us = 0;  ///< sensor time of a record's time zero
};

/// Runs `framewatch convert`. Returns 0, or 2 with every problem on stderr and no file.
int convert(const ConvertArguments& arguments);

}  // namespace framewatch::daemon
