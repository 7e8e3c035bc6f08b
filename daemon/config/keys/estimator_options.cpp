// SPDX-License-Identifier: MIT
#include "daemon/config/keys/option_table.h"
#include "estimator/setup/pipeline_config.h"

namespace framewatch::daemon {
namespace {

using enum Reach;

const Option kEstimator[] = {
    {.key = "variant",
     .choices = "matched|paper",
     .meaning = "matched: each floor's equations are filtered at its own frequencies. paper: "
                "common high-pass, trapezoid rule and least squares.",
     .target = into<&estimator::EstimatorOptions::variant>},
    {.key = "rate_hz",
     .unit = "Hz",
     .range = {1, 100000},
     .meaning = "Sampling rate of all channels.",
     .target = into<&estimator::EstimatorOptions::rate_hz>},
    {.key = "window_s",
     .unit = "s",
     .range = above(0, 3600),
     .meaning = "Window length, rounded to 20 blocks of whole samples.",
     .target = into<&estimator::EstimatorOptions::window_s>},
    {.key = "other_windows_s",
     .unit = "s",
     .shape = "[window]",
     .range = above(0, 3600),
     .meaning = "Lengths of further windows, rounded to twentieths of the main window, at least "
                "four. Published five times per length on ESTIMATE_1S and so on.",
     .target = into<&estimator::EstimatorOptions::other_windows_s>},
    {.key = "hop_s",
     .unit = "s",
     .range = above(0, 3600),
     .meaning = "Time between published windows, rounded to whole samples.",
     .target = into<&estimator::EstimatorOptions::hop_s>},
    {.key = "boxplot_windows",
     .range = {1, 100000},
     .meaning = "Number of windows in the boxplot statistics.",
     .target = into<&estimator::EstimatorOptions::boxplot_windows>},
    {.key = "high_pass_hz",
     .unit = "Hz",
     .paper_default = "0.1",
     .range = {0.001, 1000},
     .meaning = "Corner of the high-pass that limits drift.",
     .target = into<&estimator::EstimatorOptions::high_pass_hz>},
    {.key = "filter_damping",
     .range = {0.05, 2},
     .meaning = "Damping ratio of the oscillator sections.",
     .target = into<&estimator::EstimatorOptions::filter_damping>},
    {.key = "corner_ratio",
     .range = {0.1, 10},
     .meaning = "Corners of the oscillator sections relative to the floors' frequencies.",
     .target = into<&estimator::EstimatorOptions::corner_ratio>},
    {.key = "prior",
     .meaning = "Use a weak prior on the design where data are poor.",
     .target = into<&estimator::EstimatorOptions::prior>},
    {.key = "self_tune",
     .meaning = "Tune the filters to identified values.",
     .target = into<&estimator::EstimatorOptions::self_tune>},
    {.key = "settle_s",
     .unit = "s",
     .range = {0, 3600},
     .meaning = "Settling time of the filters after a start (paper variant only).",
     .target = into<&estimator::EstimatorOptions::settle_s>},
    {.key = "lateness_s",
     .unit = "s",
     .range = {0, 60},
     .meaning =
         "An instant is closed this long after its time; later samples are dropped and counted.",
     .target = into<&estimator::EstimatorOptions::lateness_s>},
    {.key = "fill_single_losses",
     .meaning = "Repair single lost samples by cubic interpolation.",
     .target = into<&estimator::EstimatorOptions::fill_single_losses>},
    {.key = "min_snr",
     .range = {0, 1e9},
     .meaning = "Smallest signal-to-noise energy ratio of a published value's regressor.",
     .reload = settings,
     .target = into<&estimator::EstimatorOptions::min_snr>},
    {.key = "max_error_k_ratio",
     .range = above(0, 100),
     .meaning = "Largest relative standard error of a published frame stiffness.",
     .reload = settings,
     .target = into<&estimator::EstimatorOptions::max_error_k>},
    {.key = "max_error_g_ratio",
     .range = above(0, 100),
     .meaning = "The same for floor panels.",
     .reload = settings,
     .target = into<&estimator::EstimatorOptions::max_error_g>},
    {.key = "max_error_c_ratio",
     .range = above(0, 100),
     .meaning = "The same for damping.",
     .reload = settings,
     .target = into<&estimator::EstimatorOptions::max_error_c>},
};

}  // namespace

std::vector<OptionSection> estimator_options() {
  return {{"estimator", kEstimator, Reach::restart}};
}

}  // namespace framewatch::daemon
