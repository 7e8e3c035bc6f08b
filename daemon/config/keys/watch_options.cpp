// SPDX-License-Identifier: MIT
#include "daemon/config/keys/watch_options.h"

#include "daemon/config/keys/option_table.h"

namespace framewatch::daemon {
namespace {

using enum OptionType;
using enum Reach;

const Option kGap[] = {
    {.key = "model",
     .meaning = "Model file, relative to this file, from `framewatch diagnose` (model.toml) or "
                "`framewatch adopt`. Default: learn a model without effects from the windows.",
     .is_path = true,
     .target = into<&GapSettings::model_path>},
    {.key = "learn_s",
     .unit = "s",
     .range = above(0, 1e6),
     .meaning = "Total window time to learn a model.",
     .target = into<&GapSettings::options, &estimator::GapOptions::learn_s>},
    {.key = "window_s",
     .type = integer,
     .unit = "s",
     .range = {1, 3600},
     .meaning = "Comparison window; evaluated every second.",
     .target = into<&GapSettings::options, &estimator::GapOptions::window_s>},
    {.key = "raise_ratio",
     .range = above(0, 10),
     .meaning =
         "Raise a gap at this rms difference beyond noise over rms motion; clear at half of it.",
     .target = into<&GapSettings::options, &estimator::GapOptions::raise_ratio>},
    {.key = "lasting_s",
     .unit = "s",
     .range = {1, 86400},
     .meaning = "Least duration of a gap before the event, and of its absence before clearing.",
     .target = into<&GapSettings::options, &estimator::GapOptions::lasting_s>},
    {.key = "store",
     .meaning = "Directory for samples of each gap, relative to this file, for `framewatch "
                "diagnose --event`. Default: not stored.",
     .is_path = true,
     .target = into<&GapSettings::store>},
    {.key = "store_before_s",
     .unit = "s",
     .range = {0, 600},
     .meaning = "Stored time before the gap.",
     .target = into<&GapSettings::before_s>},
    {.key = "store_after_s",
     .unit = "s",
     .range = {0, 600},
     .meaning = "Stored time after the gap.",
     .target = into<&GapSettings::after_s>},
};

const Option kWatch[] = {
    {.key = "baseline",
     .meaning = "Baseline file, relative to this file. `framewatch run` adds missing parameters; "
                "`framewatch replay --write-baseline` makes one. Default: each run learns its own.",
     .is_path = true,
     .target = into<&WatchSettings::baseline_path>},
    {.key = "learn_s",
     .unit = "s",
     .range = above(0, 1e6),
     .meaning = "Least total window time to learn a baseline. Learning continues until the "
                "standard error is a tenth of the smallest change.",
     .target = into<&WatchSettings::options, &estimator::WatchOptions::learn_s>},
    {.key = "smallest_change_k_ratio",
     .range = {0, 1},
     .meaning = "Smallest relevant change of a frame's stiffness (half for a group of stories). 0: "
                "not watched.",
     .target = into<&WatchSettings::options, &estimator::WatchOptions::least_change_k>},
    {.key = "smallest_change_g_ratio",
     .range = {0, 1},
     .meaning = "The same for floor panels.",
     .target = into<&WatchSettings::options, &estimator::WatchOptions::least_change_g>},
    {.key = "alarms_per_year",
     .range = above(0, 1e6),
     .meaning = "Accepted false alarms for the whole building.",
     .target = into<&WatchSettings::options, &estimator::WatchOptions::alarms_per_year>},
    {.key = "shaking_hours_per_year",
     .unit = "h",
     .range = above(0, 8766),
     .meaning = "Yearly time with enough motion for values.",
     .target = into<&WatchSettings::options, &estimator::WatchOptions::shaking_hours_per_year>},
    {.key = "false_loss_years",
     .unit = "years",
     .range = {1, 1000},
     .meaning = "Time for which false_loss_probability holds. With [history], `framewatch run` "
                "looks once a day for lasting losses in daily means ([years](years.md)).",
     .reload = restart,
     .target = into<&WatchSettings::life, &estimator::LifeBudget::years>},
    {.key = "false_loss_probability",
     .range = above(0, 0.5),
     .meaning = "Accepted probability of one false lasting loss or more in that time.",
     .reload = restart,
     .target = into<&WatchSettings::life, &estimator::LifeBudget::probability>},
    {.key = "smallest_loss_ratio",
     .range = {0.001, 0.5},
     .meaning = "Smallest lasting loss that counts.",
     .reload = restart,
     .target = into<&WatchSettings::life, &estimator::LifeBudget::least_loss>},
    {.key = "quiet_window_s",
     .unit = "s",
     .range = {0, 86400},
     .meaning = "Length of the long windows for weak motion. 0: off. Needs the sensors' noise.",
     .target = into<&WatchSettings::options, &estimator::WatchOptions::quiet_window_s>},
    {.key = "quiet_learn_hours",
     .unit = "h",
     .range = above(0, 8766),
     .meaning = "Total of long windows to learn their baseline.",
     .target = into<&WatchSettings::options, &estimator::WatchOptions::quiet_learn_hours>},
    {.key = "temperature_channel",
     .meaning = "LCM channel of temperature_t messages. Stiffness may follow the temperature; "
                "other changes are watched.",
     .reload = restart,
     .target = into<&WatchSettings::temperature_channel>},
    {.key = "follow_amplitude",
     .meaning = "Stiffness may follow the amplitude of the element's motion, once the baseline "
                "spans a factor of 3.",
     .target = into<&WatchSettings::options, &estimator::WatchOptions::amplitude>},
};

const Option kBaselineParameter[] = {
    {.key = "name", .type = text, .required = true, .meaning = "Parameter name."},
    {.key = "value", .required = true, .range = above(0), .meaning = "Reference value, in `unit`."},
    {.key = "std_error",
     .required = true,
     .range = above(0),
     .meaning = "Its standard error, in `unit`."},
    {.key = "unit", .type = text, .required = true, .meaning = "As in estimates."},
    {.key = "temperature_degc",
     .unit = "degC",
     .range = {-90, 150},
     .meaning = "Mean temperature while learning. With `temperature_channel`, the value is "
                "corrected for the temperature."},
    {.key = "amplitude_m",
     .unit = "m",
     .shape = "[point]",
     .range = above(0),
     .meaning = "Amplitudes while learning (rms deformation per window), ascending. With "
                "`follow_amplitude`, the value is corrected for them."},
    {.key = "value_at_amplitude",
     .shape = "[point]",
     .range = above(0),
     .meaning = "Values at these amplitudes, in `unit`."},
    {.key = "std_error_at_amplitude",
     .shape = "[point]",
     .range = above(0),
     .meaning = "Their standard errors, in `unit`."},
};

}  // namespace

std::vector<OptionSection> watch_options() {
  return {{"watch", kWatch, Reach::settings},
          {"baseline.parameter", kBaselineParameter},
          {"gap", kGap, Reach::settings}};
}

}  // namespace framewatch::daemon
