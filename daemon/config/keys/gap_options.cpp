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
     .meaning =
         "File of the model to simulate, beside this one unless its path says otherwise: what "
         "`framewatch diagnose` calls model.toml and `framewatch adopt` puts there, even "
         "while `framewatch run` is running. While it does not exist the model is learned: "
         "what the windows identify, without effects.",
     .reload = settings,
     .is_path = true,
     .target = into<&GapSettings::model_path>},
    {.section = "gap",
     .key = "learn_s",
     .unit = "s",
     .default_value = "60",
     .min = 0,
     .max = 1e6,
     .above_min = true,
     .meaning = "Sum of the windows with values that a model is learned from.",
     .reload = settings,
     .target = into<&GapSettings::options, &estimator::GapOptions::learn_s>},
    {.section = "gap",
     .key = "window_s",
     .type = integer,
     .unit = "s",
     .default_value = "10",
     .min = 1,
     .max = 3600,
     .meaning = "Simulation and measurement are compared over this time, once a second.",
     .reload = settings,
     .target = into<&GapSettings::options, &estimator::GapOptions::window_s>},
    {.section = "gap",
     .key = "raise_ratio",
     .default_value = "0.15",
     .min = 0,
     .max = 10,
     .above_min = true,
     .meaning = "Difference beyond noise over measured motion, root mean square, from which on a "
                "gap is one; it is over at half of it.",
     .reload = settings,
     .target = into<&GapSettings::options, &estimator::GapOptions::raise_ratio>},
    {.section = "gap",
     .key = "lasting_s",
     .unit = "s",
     .default_value = "10",
     .min = 1,
     .max = 86400,
     .meaning = "So long a gap lasts before it is an event, and is over before it is cleared.",
     .reload = settings,
     .target = into<&GapSettings::options, &estimator::GapOptions::lasting_s>},
    {.section = "gap",
     .key = "store",
     .type = text,
     .meaning = "Directory for the samples that show a gap, one LCM event log per event, for "
                "`framewatch diagnose --event`; beside this file unless the path says otherwise. "
                "Without it none are stored.",
     .reload = settings,
     .is_path = true,
     .target = into<&GapSettings::store>},
    {.section = "gap",
     .key = "store_before_s",
     .unit = "s",
     .default_value = "30",
     .min = 0,
     .max = 600,
     .meaning = "Samples from so long before a gap is raised are stored, ...",
     .reload = settings,
     .target = into<&GapSettings::before_s>},
    {.section = "gap",
     .key = "store_after_s",
     .unit = "s",
     .default_value = "60",
     .min = 0,
     .max = 600,
     .meaning = "... and until so long after it. They are kept in memory until then.",
     .reload = settings,
     .target = into<&GapSettings::after_s>},
};

}  // namespace

std::span<const Option> gap_options() {
  return kOptions;
}

}  // namespace framewatch::daemon
