#include "daemon/config/keys/event_report_options.h"

#include "daemon/config/keys/option_table.h"

namespace framewatch::daemon {
namespace {

using enum OptionType;
using enum Reach;

const Option kOptions[] = {
    {.section = "event_report",
     .key = "directory",
     .type = text,
     .required = true,
     .meaning = "Where a page and a JSON file are written after every strong motion; beside this "
                "file unless the path says otherwise. It is made when it is not there.",
     .reload = restart,
     .is_path = true,
     .target = into<&EventReportSettings::directory>},
    {.section = "event_report",
     .key = "trigger_mps2",
     .unit = "m/s^2",
     .default_value = "0.1",
     .min = 1e-4,
     .max = 50,
     .meaning = "The base moves strongly above this distance from its mean, ...",
     .reload = restart,
     .target = into<&EventReportSettings::options, &estimator::ShakingOptions::trigger_mps2>},
    {.section = "event_report",
     .key = "quiet_s",
     .unit = "s",
     .default_value = "20",
     .min = 2,
     .max = 45,
     .meaning =
         "... and strong motion has ended when it has not for so long; then the report is written.",
     .reload = restart,
     .target = into<&EventReportSettings::options, &estimator::ShakingOptions::quiet_s>},
    {.section = "event_report",
     .key = "yellow_drift_ratio",
     .default_value = "0.005",
     .min = 0,
     .max = 1,
     .meaning = "Peak drift of a story over its height from which on the report is yellow, ...",
     .reload = restart,
     .target = into<&EventReportSettings::yellow_drift_ratio>},
    {.section = "event_report",
     .key = "red_drift_ratio",
     .default_value = "0.015",
     .min = 0,
     .max = 1,
     .meaning = "... and red.",
     .reload = restart,
     .target = into<&EventReportSettings::red_drift_ratio>},
    {.section = "event_report",
     .key = "yellow_loss_ratio",
     .default_value = "0.05",
     .min = 0,
     .max = 1,
     .meaning = "Lasting loss of a stiffness, beyond three standard errors, from which on the "
                "report is yellow, ...",
     .reload = restart,
     .target = into<&EventReportSettings::yellow_loss_ratio>},
    {.section = "event_report",
     .key = "red_loss_ratio",
     .default_value = "0.2",
     .min = 0,
     .max = 1,
     .meaning = "... and red.",
     .reload = restart,
     .target = into<&EventReportSettings::red_loss_ratio>},
    {.section = "event_report",
     .key = "most_reports",
     .type = integer,
     .default_value = "500",
     .min = 1,
     .max = 100000,
     .meaning = "So many reports are kept: the oldest are removed.",
     .reload = restart,
     .target = into<&EventReportSettings::most_reports>},
};

constexpr std::string_view kByHand = "one for all stories or one for each; type may give it";

constexpr Option median(std::string_view key, std::string_view meaning) {
  return {.section = "fragility",
          .key = key,
          .type = grid,
          .shape = "[story]",
          .min = 0,
          .max = 0.5,
          .above_min = true,
          .meaning = meaning,
          .reload = restart,
          .by_hand = kByHand};
}

constexpr Option dispersion(std::string_view key, std::string_view meaning) {
  return {.section = "fragility",
          .key = key,
          .type = grid,
          .shape = "[story]",
          .default_value = "0.4",
          .min = 0.05,
          .max = 1.5,
          .meaning = meaning,
          .reload = restart,
          .by_hand = kByHand};
}

const Option kFragility[] = {
    {.section = "fragility",
     .key = "type",
     .type = choice,
     .choices = "W1|W2|S1|S1L|S1M|S1H|S2|S2L|S2M|S2H|S3|S4|S4L|S4M|S4H|S5|S5L|S5M|S5H|C1|C1L|C1M|"
                "C1H|C2|C2L|C2M|C2H|C3|C3L|C3M|C3H|PC1|PC2|PC2L|PC2M|PC2H|RM1|RM1L|RM1M|RM2|RM2L|"
                "RM2M|RM2H|URM|URML|URMM",
     .meaning = "HAZUS' model building type, whose drift limits are the medians: W wood, S steel "
                "(1 moment frame, 2 braced, 4 with concrete walls, 5 with infill), C concrete "
                "(1 moment frame, 2 walls, 3 infill), PC precast, RM and URM reinforced and "
                "unreinforced masonry. L, M, H ask for the limits of low-, mid- or high-rise.",
     .reload = restart,
     .by_hand = "a text that is looked up in a table"},
    {.section = "fragility",
     .key = "design_level",
     .type = choice,
     .choices = "high|moderate|low|pre",
     .meaning = "The seismic code the building was designed by; needed with type. pre: before "
                "there was one. S5, C3 and URM have limits of low and pre only.",
     .reload = restart,
     .target = into<&FragilitySettings::design_level>},
    {.section = "fragility",
     .key = "drift_limits",
     .type = choice,
     .default_value = "\"story\"",
     .choices = "story|height",
     .meaning =
         "story: a type without L, M, H has HAZUS' low-rise limits, which are those of a "
         "single story's drift, as it is measured here. height: the limits go by the "
         "number of stories; those of mid-rise (times 2/3) and high-rise (times 1/2) are for "
         "the average drift of a building and call damage earlier.",
     .reload = restart,
     .target = into<&FragilitySettings::drift_limits>},
    median("slight_drift_ratio",
           "Median drift over story height at which slight structural damage begins; in place of "
           "the type's."),
    median("moderate_drift_ratio", "Likewise moderate damage."),
    median("extensive_drift_ratio", "Likewise extensive damage."),
    median("complete_drift_ratio", "Likewise complete damage."),
    dispersion("slight_dispersion",
               "Standard deviation of the logarithm of that drift for slight damage; HAZUS' "
               "uncertainty of the limit itself, without that of the shaking, which is measured."),
    dispersion("moderate_dispersion", "Likewise moderate damage."),
    dispersion("extensive_dispersion", "Likewise extensive damage."),
    dispersion("complete_dispersion", "Likewise complete damage."),
    {.section = "fragility",
     .key = "restricted_probability",
     .default_value = "0.25",
     .min = 0.01,
     .max = 0.99,
     .meaning = "Probability of moderate or worse damage in any story from which on the placard "
                "says restricted use.",
     .reload = restart,
     .target = into<&FragilitySettings::rules, &estimator::PlacardRules::restricted>},
    {.section = "fragility",
     .key = "unsafe_probability",
     .default_value = "0.25",
     .min = 0.01,
     .max = 0.99,
     .meaning = "Probability of extensive or worse damage in any story from which on it says "
                "unsafe.",
     .reload = restart,
     .target = into<&FragilitySettings::rules, &estimator::PlacardRules::unsafe>},
};

}  // namespace

std::span<const Option> event_report_options() {
  return kOptions;
}

std::span<const Option> fragility_options() {
  return kFragility;
}

}  // namespace framewatch::daemon
