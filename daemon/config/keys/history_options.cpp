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
     .meaning = "Where everything is kept; beside this file unless the path says otherwise. It is "
                "made when it is not there.",
     .reload = restart,
     .is_path = true,
     .target = into<&HistorySettings::directory>},
    {.section = "history",
     .key = "rotate_s",
     .unit = "s",
     .default_value = "3600",
     .min = 1,
     .max = 86400,
     .meaning = "A raw log ends at the multiples of this sensor time, ...",
     .reload = restart,
     .target = into<&HistorySettings::rotate_s>},
    {.section = "history",
     .key = "rotate_mb",
     .unit = "MB",
     .default_value = "64",
     .min = 0.01,
     .max = 4000,
     .meaning = "... or when it has this size.",
     .reload = restart,
     .target = into<&HistorySettings::rotate_mb>},
    {.section = "history",
     .key = "compress",
     .type = boolean,
     .default_value = "true",
     .meaning = "Raw logs that have ended are compressed (zstd).",
     .reload = restart,
     .target = into<&HistorySettings::compress>},
    {.section = "history",
     .key = "keep_days",
     .unit = "days",
     .default_value = "30",
     .min = 0,
     .max = 36500,
     .above_min = true,
     .meaning = "Raw logs are removed when they are older than this, by sensor time, ...",
     .reload = restart,
     .target = into<&HistorySettings::keep_days>},
    {.section = "history",
     .key = "keep_gb",
     .unit = "GB",
     .default_value = "20",
     .min = 0,
     .max = 1e6,
     .above_min = true,
     .meaning = "... or when together they are larger than this, the oldest first.",
     .reload = restart,
     .target = into<&HistorySettings::keep_gb>},
    {.section = "history",
     .key = "event_before_s",
     .unit = "s",
     .default_value = "60",
     .min = 0,
     .max = 3600,
     .meaning = "Raw samples are kept for ever from so long before a warning or an alarm began, "
                "...",
     .reload = restart,
     .target = into<&HistorySettings::event_before_s>},
    {.section = "history",
     .key = "event_after_s",
     .unit = "s",
     .default_value = "120",
     .min = 0,
     .max = 3600,
     .meaning = "... until so long after it was raised.",
     .reload = restart,
     .target = into<&HistorySettings::event_after_s>},
    {.section = "history",
     .key = "resolution_mps2",
     .unit = "m/s^2",
     .default_value = "1e-6",
     .min = 0,
     .max = 1,
     .above_min = true,
     .meaning = "Raw samples are stored as whole multiples of this. The step of the sensor's "
                "converter keeps its integers; a finer one costs disk space.",
     .reload = restart,
     .target = into<&HistorySettings::resolution_mps2>},
    {.section = "history",
     .key = "summary_s",
     .type = grid,
     .unit = "s",
     .shape = "[period]",
     .default_value = "[60, 600, 3600]",
     .min = 1,
     .max = 86400,
     .meaning = "Periods that are summarised, ascending, each a multiple of the one before; the "
                "first at most 60 s, and that often they go to the disk.",
     .reload = restart,
     .target = into<&HistorySettings::summary_s>},
    {.section = "history",
     .key = "keep_summary_days",
     .unit = "days",
     .default_value = "400",
     .min = 1,
     .max = 36500,
     .meaning = "Summaries of the first of these periods are removed when they are older. Those of "
                "the others, and events, are kept for ever.",
     .reload = restart,
     .target = into<&HistorySettings::keep_summary_days>},
};

}  // namespace

std::span<const Option> history_options() {
  return kOptions;
}

}  // namespace framewatch::daemon
