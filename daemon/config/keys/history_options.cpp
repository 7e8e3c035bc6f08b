// SPDX-License-Identifier: MIT
#include "daemon/config/keys/history_options.h"

#include "daemon/config/keys/option_table.h"

namespace framewatch::daemon {
namespace {

using enum OptionType;
using enum Reach;

const Option kOptions[] = {
    {.section = "history",
     .key = "directory",
     .type = text,
     .required = true,
     .meaning = "Directory, relative to this file; created if missing.",
     .reload = restart,
     .is_path = true,
     .target = into<&HistorySettings::directory>},
    {.section = "history",
     .key = "rotate_s",
     .unit = "s",
     .min = 1,
     .max = 86400,
     .meaning = "A raw log ends at multiples of this sensor time.",
     .reload = restart,
     .target = into<&HistorySettings::rotate_s>},
    {.section = "history",
     .key = "rotate_mb",
     .unit = "MB",
     .min = 0.01,
     .max = 4000,
     .meaning = "A raw log ends at this size.",
     .reload = restart,
     .target = into<&HistorySettings::rotate_mb>},
    {.section = "history",
     .key = "compress",
     .type = boolean,
     .meaning = "Compress finished raw logs (zstd).",
     .reload = restart,
     .target = into<&HistorySettings::compress>},
    {.section = "history",
     .key = "keep_days",
     .unit = "days",
     .min = 0,
     .max = 36500,
     .above_min = true,
     .meaning = "Remove raw logs older than this, by sensor time.",
     .reload = restart,
     .target = into<&HistorySettings::keep_days>},
    {.section = "history",
     .key = "keep_gb",
     .unit = "GB",
     .min = 0,
     .max = 1e6,
     .above_min = true,
     .meaning = "Remove the oldest raw logs beyond this total size.",
     .reload = restart,
     .target = into<&HistorySettings::keep_gb>},
    {.section = "history",
     .key = "event_before_s",
     .unit = "s",
     .min = 0,
     .max = 3600,
     .meaning = "Keep raw samples forever from this time before a warning or alarm began.",
     .reload = restart,
     .target = into<&HistorySettings::event_before_s>},
    {.section = "history",
     .key = "event_after_s",
     .unit = "s",
     .min = 0,
     .max = 3600,
     .meaning = "Keep raw samples forever until this time after the warning or alarm was raised.",
     .reload = restart,
     .target = into<&HistorySettings::event_after_s>},
    {.section = "history",
     .key = "resolution_mps2",
     .unit = "m/s^2",
     .min = 0,
     .max = 1,
     .above_min = true,
     .meaning = "Raw samples are stored as multiples of this. Use the converter's step to keep its "
                "integers.",
     .reload = restart,
     .target = into<&HistorySettings::resolution_mps2>},
    {.section = "history",
     .key = "summary_s",
     .type = grid,
     .unit = "s",
     .shape = "[period]",
     .min = 1,
     .max = 86400,
     .meaning =
         "Summary periods, ascending, each a multiple of the one before; the first at most 60 s.",
     .reload = restart,
     .target = into<&HistorySettings::summary_s>},
    {.section = "history",
     .key = "keep_summary_days",
     .unit = "days",
     .min = 1,
     .max = 36500,
     .meaning = "Remove summaries of the first period older than this. Other summaries and events "
                "are kept forever.",
     .reload = restart,
     .target = into<&HistorySettings::keep_summary_days>},
};

}  // namespace

std::span<const Option> history_options() {
  return kOptions;
}

}  // namespace framewatch::daemon
