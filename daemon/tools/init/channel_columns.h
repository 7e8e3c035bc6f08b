// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/base/record_file_arguments.h"
#include "daemon/tools/init/building_plan.h"

namespace framewatch::daemon {

/// The candidates for channels of a record or a CAN bus.
struct ChannelColumns {
  std::vector<ChannelColumn> columns;
  double rate_hz = 0;              ///< of a record, rounded as its times are; 0: not known
  std::vector<std::string> notes;  ///< what the reader assumed or left out
  std::string problem;             ///< why there is nothing, of several lines; empty: all is well
};

/// Returns the channels of all files, which must share one clock.
ChannelColumns columns_of_records(const std::vector<std::string>& paths,
                                  const RecordFileArguments& arguments);

/// The signals of a DBC file whose unit is one of acceleration.
ChannelColumns columns_of_dbc(const std::string& path, const std::string& interface);

/// The answer "rec.csv --unit g": a file name or pattern ("np8040/*.V1c.gz") and options. A word
/// that is not such an option is a problem.
struct RecordAnswer {
  std::vector<std::string> paths;  ///< one at least
  RecordFileArguments arguments;
  std::string problem;
};
RecordAnswer parse_record_answer(const std::string& text);

/// The options as they are typed: " --unit g"; a text in quotes where a shell wants them.
std::string options_text(const RecordFileArguments& arguments);
std::string shell_word(const std::string& text);

}  // namespace framewatch::daemon
