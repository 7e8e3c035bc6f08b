#include "daemon/config/keys/watch_options.h"

#include "daemon/config/keys/option_table.h"

namespace framewatch::daemon {
namespace {

using enum OptionType;
using enum Reach;

const Option kOptions[] = {
    {.section = "watch",
     .key = "baseline",
     .type = text,
     .meaning =
         "File of reference parameters, beside this one unless its path says otherwise. "
         "Parameters that it lacks, all when it does not exist, `framewatch run` learns and "
         "adds to it; `framewatch replay --write-baseline` makes one from records. Without a "
         "file every run learns its own.",
     .reload = settings,
     .is_path = true,
     .target = into<&WatchSettings::baseline_path>},
    {.section = "watch",
     .key = "learn_s",
     .unit = "s",
     .default_value = "60",
     .min = 0,
     .max = 1e6,
     .above_min = true,
     .meaning =
         "Sum of the windows that every parameter's baseline is learned from at least; it is "
         "learned on until its standard error is a tenth of the smallest change.",
     .reload = settings,
     .target = into<&WatchSettings::options, &estimator::WatchOptions::learn_s>},
    {.section = "watch",
     .key = "smallest_change_k_ratio",
     .default_value = "0.03",
     .min = 0,
     .max = 1,
     .meaning =
         "Smallest lasting change of a frame's stiffness that matters, half as much of a group of "
         "stories; 0: not watched.",
     .reload = settings,
     .target = into<&WatchSettings::options, &estimator::WatchOptions::least_change_k>},
    {.section = "watch",
     .key = "smallest_change_g_ratio",
     .default_value = "0.2",
     .min = 0,
     .max = 1,
     .meaning = "The same of a floor panel's.",
     .reload = settings,
     .target = into<&WatchSettings::options, &estimator::WatchOptions::least_change_g>},
    {.section = "watch",
     .key = "alarms_per_year",
     .default_value = "1",
     .min = 0,
     .max = 1e6,
     .above_min = true,
     .meaning = "False alarms that are put up with, of the whole building.",
     .reload = settings,
     .target = into<&WatchSettings::options, &estimator::WatchOptions::alarms_per_year>},
    {.section = "watch",
     .key = "shaking_hours_per_year",
     .unit = "h",
     .default_value = "10",
     .min = 0,
     .max = 8766,
     .above_min = true,
     .meaning = "Time a year in which the building moves enough for windows to have values.",
     .reload = settings,
     .target = into<&WatchSettings::options, &estimator::WatchOptions::shaking_hours_per_year>},
    {.section = "watch",
     .key = "quiet_window_s",
     .unit = "s",
     .default_value = "3600",
     .min = 0,
     .max = 86400,
     .meaning = "Length of the long windows that weak motion is accumulated in and watched, with "
                "a baseline of their own; 0: none. The sensors' noise has to be configured.",
     .reload = settings,
     .target = into<&WatchSettings::options, &estimator::WatchOptions::quiet_window_s>},
    {.section = "watch",
     .key = "quiet_learn_hours",
     .unit = "h",
     .default_value = "24",
     .min = 0,
     .max = 8766,
     .above_min = true,
     .meaning = "Sum of the long windows that their baseline is learned from, and how it follows "
                "temperature and amplitude.",
     .reload = settings,
     .target = into<&WatchSettings::options, &estimator::WatchOptions::quiet_learn_hours>},
    {.section = "watch",
     .key = "temperature_channel",
     .type = text,
     .meaning = "LCM channel of temperature_t messages: stiffness may follow the temperature, and "
                "is watched for what that does not explain.",
     .reload = restart,
     .target = into<&WatchSettings::temperature_channel>},
    {.section = "watch",
     .key = "follow_amplitude",
     .type = boolean,
     .default_value = "true",
     .meaning = "Stiffness may follow the amplitude of the element's own motion, and recovers some "
                "time after a strong one; it is watched for what that does not explain, where the "
                "baseline spans amplitudes 3 times apart or more.",
     .reload = settings,
     .target = into<&WatchSettings::options, &estimator::WatchOptions::amplitude>},
    {.section = "baseline.parameter",
     .key = "name",
     .type = text,
     .required = true,
     .meaning = "The parameter."},
    {.section = "baseline.parameter",
     .key = "value",
     .required = true,
     .min = 0,
     .above_min = true,
     .meaning = "Its reference value, in `unit`."},
    {.section = "baseline.parameter",
     .key = "std_error",
     .required = true,
     .min = 0,
     .above_min = true,
     .meaning = "How well that is known, likewise."},
    {.section = "baseline.parameter",
     .key = "unit",
     .type = text,
     .required = true,
     .meaning = "As in estimates."},
    {.section = "baseline.parameter",
     .key = "temperature_degc",
     .unit = "degC",
     .min = -90,
     .max = 150,
     .meaning = "Mean temperature at which it was learned: with `temperature_channel` the value is "
                "corrected for the temperature since."},
    {.section = "baseline.parameter",
     .key = "amplitude_m",
     .type = grid,
     .unit = "m",
     .shape = "[point]",
     .min = 0,
     .above_min = true,
     .meaning = "Amplitudes of the element it was learned at, ascending: rms deformation of a "
                "window. With `follow_amplitude` the value is corrected for them."},
    {.section = "baseline.parameter",
     .key = "value_at_amplitude",
     .type = grid,
     .shape = "[point]",
     .min = 0,
     .above_min = true,
     .meaning = "Its values there, in `unit`."},
    {.section = "baseline.parameter",
     .key = "std_error_at_amplitude",
     .type = grid,
     .shape = "[point]",
     .min = 0,
     .above_min = true,
     .meaning = "How well those are known, likewise."},
};

}  // namespace

std::span<const Option> watch_options() {
  return kOptions;
}

}  // namespace framewatch::daemon
