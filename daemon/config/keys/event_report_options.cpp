// SPDX-License-Identifier: MIT
#include "daemon/config/keys/event_report_options.h"

#include "daemon/config/keys/option_table.h"

namespace framewatch::daemon {
namespace {

const Option kEventReport[] = {
    {.key = "directory",
     .required = true,
     .meaning = "Directory, relative to this file; created if missing. Reports are written here.",
     .is_path = true,
     .target = into<&EventReportSettings::directory>},
    {.key = "trigger_mps2",
     .unit = "m/s^2",
     .range = {1e-4, 50},
     .meaning = "Strong motion begins when the base is this far from its mean.",
     .target = into<&EventReportSettings::options, &estimator::ShakingOptions::trigger_mps2>},
    {.key = "quiet_s",
     .unit = "s",
     .range = {2, 45},
     .meaning = "Strong motion ends after this time below the trigger.",
     .target = into<&EventReportSettings::options, &estimator::ShakingOptions::quiet_s>},
    {.key = "yellow_drift_ratio",
     .range = {0, 1},
     .meaning = "Peak drift over story height that makes the report yellow.",
     .target = into<&EventReportSettings::yellow_drift_ratio>},
    {.key = "red_drift_ratio",
     .range = {0, 1},
     .meaning = "Peak drift over story height that makes the report red.",
     .target = into<&EventReportSettings::red_drift_ratio>},
    {.key = "yellow_loss_ratio",
     .range = {0, 1},
     .meaning =
         "Lasting stiffness loss, beyond three standard errors, that makes the report yellow.",
     .target = into<&EventReportSettings::yellow_loss_ratio>},
    {.key = "red_loss_ratio",
     .range = {0, 1},
     .meaning = "Lasting stiffness loss that makes the report red.",
     .target = into<&EventReportSettings::red_loss_ratio>},
    {.key = "most_reports",
     .range = {1, 100000},
     .meaning = "Number of reports to keep; the oldest are removed.",
     .target = into<&EventReportSettings::most_reports>},
};

constexpr std::string_view kByHand = "one for all stories or one for each; type may give it";

Option median(std::string_view key) {
  return {.key = key,
          .shape = "[story]",
          .range = above(0, 0.5),
          .meaning = "Median story drift ratio at which this damage begins. Default: by type.",
          .by_hand = kByHand};
}

Option dispersion(std::string_view key) {
  return {.key = key,
          .shape = "[story]",
          .default_value = "0.4",
          .range = {0.05, 1.5},
          .meaning =
              "Standard deviation of that drift's logarithm, without the uncertainty of the "
              "shaking.",
          .by_hand = kByHand};
}

const Option kFragility[] = {
    {.key = "type",
     .choices = "W1|W2|S1|S1L|S1M|S1H|S2|S2L|S2M|S2H|S3|S4|S4L|S4M|S4H|S5|S5L|S5M|S5H|C1|C1L|C1M|"
                "C1H|C2|C2L|C2M|C2H|C3|C3L|C3M|C3H|PC1|PC2|PC2L|PC2M|PC2H|RM1|RM1L|RM1M|RM2|RM2L|"
                "RM2M|RM2H|URM|URML|URMM",
     .meaning = "HAZUS building type: W wood, S steel (1 moment frame, 2 braced, 4 concrete walls, "
                "5 infill), C concrete (1 moment frame, 2 walls, 3 infill), PC precast, RM and URM "
                "reinforced and unreinforced masonry. L, M, H: low-, mid-, high-rise limits.",
     .by_hand = "a text that is looked up in a table"},
    {.key = "design_level",
     .no_default = true,
     .choices = "high|moderate|low|pre",
     .meaning = "Seismic code of the design; required with type. pre: before codes. S5, C3 and URM "
                "have only low and pre.",
     .target = into<&FragilitySettings::design_level>},
    {.key = "drift_limits",
     .choices = "story|height",
     .meaning = "story: types without L, M, H use low-rise limits, which apply to a single story. "
                "height: limits follow the number of stories and judge damage earlier.",
     .target = into<&FragilitySettings::drift_limits>},
    median("slight_drift_ratio"),
    median("moderate_drift_ratio"),
    median("extensive_drift_ratio"),
    median("complete_drift_ratio"),
    dispersion("slight_dispersion"),
    dispersion("moderate_dispersion"),
    dispersion("extensive_dispersion"),
    dispersion("complete_dispersion"),
    {.key = "restricted_probability",
     .range = {0.01, 0.99},
     .meaning =
         "Probability of at least moderate damage in a story for the placard restricted use.",
     .target = into<&FragilitySettings::rules, &estimator::PlacardRules::restricted>},
    {.key = "unsafe_probability",
     .range = {0.01, 0.99},
     .meaning = "Probability of at least extensive damage in a story for the placard unsafe.",
     .target = into<&FragilitySettings::rules, &estimator::PlacardRules::unsafe>},
};

}  // namespace

std::vector<OptionSection> event_report_options() {
  return {{"event_report", kEventReport, Reach::restart},
          {"fragility", kFragility, Reach::restart}};
}

}  // namespace framewatch::daemon
