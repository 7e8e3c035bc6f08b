// SPDX-License-Identifier: MIT
#include "daemon/config/keys/history_options.h"

#include "daemon/config/keys/option_table.h"

namespace framewatch::daemon {
namespace {

const Option kHistory[] = {
    {.key = "directory",
     .required = true,
     .meaning = "Directory, relative to this file; created if missing.",
     .is_path = true,
     .target = into<&HistorySettings::directory>},
    {.key = "rotate_s",
     .unit = "s",
     .range = {1, 86400},
     .meaning = "A raw log ends at multiples of this sensor time.",
     .target = into<&HistorySettings::rotate_s>},
    {.key = "rotate_mb",
     .unit = "MB",
     .range = {0.01, 4000},
     .meaning = "A raw log ends at this size.",
     .target = into<&HistorySettings::rotate_mb>},
    {.key = "compress",
     .meaning = "Compress finished raw logs (zstd).",
     .target = into<&HistorySettings::compress>},
    {.key = "keep_days",
     .unit = "days",
     .range = above(0, 36500),
     .meaning = "Remove raw logs older than this, by sensor time.",
     .target = into<&HistorySettings::keep_days>},
    {.key = "keep_gb",
     .unit = "GB",
     .range = above(0, 1e6),
     .meaning = "Remove the oldest raw logs beyond this total size.",
     .target = into<&HistorySettings::keep_gb>},
    {.key = "event_before_s",
     .unit = "s",
     .range = {0, 3600},
     .meaning = "Keep raw samples forever from this time before a warning or alarm began.",
     .target = into<&HistorySettings::event_before_s>},
    {.key = "event_after_s",
     .unit = "s",
     .range = {0, 3600},
     .meaning = "Keep raw samples forever until this time after the warning or alarm was raised.",
     .target = into<&HistorySettings::event_after_s>},
    {.key = "resolution_mps2",
     .unit = "m/s^2",
     .range = above(0, 1),
     .meaning = "Raw samples are stored as multiples of this. Use the converter's step to keep its "
                "integers.",
     .target = into<&HistorySettings::resolution_mps2>},
    {.key = "summary_s",
     .unit = "s",
     .shape = "[period]",
     .range = {1, 86400},
     .meaning =
         "Summary periods, ascending, each a multiple of the one before; the first at most 60 s.",
     .target = into<&HistorySettings::summary_s>},
    {.key = "keep_summary_days",
     .unit = "days",
     .range = {1, 36500},
     .meaning = "Remove summaries of the first period older than this. Other summaries and events "
                "are kept forever.",
     .target = into<&HistorySettings::keep_summary_days>},
};

}  // namespace

std::vector<OptionSection> history_options() {
  return {{"history", kHistory, Reach::restart}};
}

}  // namespace framewatch::daemon
