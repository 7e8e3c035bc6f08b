#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/files/file_problems.h"
#include "drivers/records/record.h"

namespace framewatch::drivers {

enum class MergeSpan {
  common,  ///< the instants every record has
  all,     ///< from the first to the last instant of any, NaN where a record has none
};

/// Puts records of one rate and one clock beside each other on the first one's instants. `where` is
/// each record's place in messages. Headers go with their axes. Empty, with every problem, when the
/// rates differ, the clocks do not overlap, the instants lie more than a tenth of a step apart or a
/// name appears twice.
std::optional<Record> merge_records(std::vector<Record> records,
                                    const std::vector<std::string>& where, MergeSpan span,
                                    std::vector<Problem>& problems);

}  // namespace framewatch::drivers
