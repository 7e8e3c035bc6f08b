#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/base/record_file_arguments.h"

namespace framewatch::daemon {

struct ConvertArguments {
  std::vector<std::string> inputs;  ///< record files, or one LCM event log
  std::string out;                  ///< .lcmlog, .csv or .csv.gz
  RecordFileArguments record;       ///< what record files do not say themselves
  std::string config;   ///< whose channels say where named columns travel; empty: by column number
  std::string channel;  ///< LCM channel to write or read; empty: ACCEL, or the only one of its kind
  bool boxplot = false;
  bool denoise = false;       ///< the paper's removal of noise on every channel of a record
  std::int64_t start_us = 0;  ///< sensor time of a record's time zero
};

/// framewatch convert. Exit code: 0, or 2 with every problem on stderr and no file.
int convert(const ConvertArguments& arguments);

}  // namespace framewatch::daemon
