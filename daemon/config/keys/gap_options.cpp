#include "daemon/config/keys/gap_options.h"

#include "daemon/config/keys/option_table.h"

namespace framewatch::daemon {
namespace {

using enum OptionType;
using enum Reach;

const Option kOptions[] = {
    {.section = "gap",
     .key = "model",
     .type = text,
     .meaning = "Model file, relative to this file, from `framewatch diagnose` (model.toml) or "
                "`framewatch adopt`. Default: learn a model without effects from the windows.",
     .reload = settings,
     .is_path = true,
     .target = into<&GapSettings::model_path>},
    {.section = "gap",
     .key = "learn_s",
     .unit = "s",
     .min = 0,
     .max = 1e6,
     .above_min = true,
     .meaning = "Total window time to learn a model.",
     .reload = settings,
     .target = into<&GapSettings::options, &estimator::GapOptions::learn_s>},
    {.section = "gap",
     .key = "window_s",
     .type = integer,
     .unit = "s",
     .min = 1,
     .max = 3600,
     .meaning = "Comparison window; evaluated every second.",
     .reload = settings,
     .target = into<&GapSettings::options, &estimator::GapOptions::window_s>},
    {.section = "gap",
     .key = "raise_ratio",
     .min = 0,
     .max = 10,
     .above_min = true,
     .meaning =
         "Raise a gap at this rms difference beyond noise over rms motion; clear at half of it.",
     .reload = settings,
     .target = into<&GapSettings::options, &estimator::GapOptions::raise_ratio>},
    {.section = "gap",
     .key = "lasting_s",
     .unit = "s",
     .min = 1,
     .max = 86400,
     .meaning = "Least duration of a gap before the event, and of its absence before clearing.",
     .reload = settings,
     .target = into<&GapSettings::options, &estimator::GapOptions::lasting_s>},
    {.section = "gap",
     .key = "store",
     .type = text,
     .meaning = "Directory for samples of each gap, relative to this file, for `framewatch "
                "diagnose --event`. Default: not stored.",
     .reload = settings,
     .is_path = true,
     .target = into<&GapSettings::store>},
    {.section = "gap",
     .key = "store_before_s",
     .unit = "s",
     .min = 0,
     .max = 600,
     .meaning = "Stored time before the gap.",
     .reload = settings,
     .target = into<&GapSettings::before_s>},
    {.section = "gap",
     .key = "store_after_s",
     .unit = "s",
     .min = 0,
     .max = 600,
     .meaning = "Stored time after the gap.",
     .reload = settings,
     .target = into<&GapSettings::after_s>},
};

}  // namespace

std::span<const Option> gap_options() {
  return kOptions;
}

}  // namespace framewatch::daemon
