// SPDX-License-Identifier: MIT
#include "daemon/config/keys/event_report_options.h"

#include "daemon/config/keys/option_table.h"

namespace framewatch::daemon {
namespace {

using enum OptionType;
using enum Reach;

const Option kActions[] = {
    {.section = "actions",
     .key = "severity",
     .type = choice,
     .choices = "information|warning|alarm",
     .meaning = "Least severity of notified events. Their end is notified too.",
     .reload = settings,
     .target = into<&ActionSettings::severity>},
    {.section = "actions",
     .key = "kinds",
     .type = texts,
     .meaning = "Kinds of events, such as \"stiffness_change\", \"gap\", \"bus_off\". Empty: all.",
     .reload = settings,
     .target = into<&ActionSettings::kinds>},
    {.section = "actions",
     .key = "changed_every_s",
     .unit = "s",
     .min = 0,
     .max = 86400,
     .meaning = "Least time between notifications of one event's changes; the newest change is "
                "always sent.",
     .reload = settings,
     .target = into<&ActionSettings::changed_every_s>},
    {.section = "actions",
     .key = "per_minute",
     .type = integer,
     .unit = "1/min",
     .min = 1,
     .max = 6000,
     .meaning = "Most events per minute, each for the command and the webhook. Others wait, the "
                "most severe first.",
     .reload = settings,
     .target = into<&ActionSettings::per_minute>},
    {.section = "actions",
     .key = "command",
     .type = texts,
     .meaning = "Program and arguments, run once per event without a shell. The event is JSON on "
                "standard input and FRAMEWATCH_* in the environment.",
     .reload = settings,
     .target = into<&ActionSettings::command>},
    {.section = "actions",
     .key = "command_timeout_s",
     .unit = "s",
     .min = 0.1,
     .max = 3600,
     .meaning = "The command's process group is ended after this time.",
     .reload = settings,
     .target = into<&ActionSettings::command_timeout_s>},
    {.section = "actions",
     .key = "webhook",
     .type = text,
     .meaning = "http:// or https:// address for a POST with JSON per event.",
     .reload = settings,
     .target = into<&ActionSettings::webhook>},
    {.section = "actions",
     .key = "webhook_header_file",
     .type = text,
     .meaning = "File of further request headers, one per line, relative to this file: "
                "\"Authorization: Bearer ...\". Read for each request.",
     .reload = settings,
     .is_path = true,
     .target = into<&ActionSettings::webhook_header_file>},
    {.section = "actions",
     .key = "webhook_ca_file",
     .type = text,
     .meaning = "CA certificates (PEM) for the server, instead of the system's.",
     .reload = settings,
     .is_path = true,
     .target = into<&ActionSettings::webhook_ca_file>},
    {.section = "actions",
     .key = "webhook_timeout_s",
     .unit = "s",
     .min = 0.1,
     .max = 300,
     .meaning = "Timeout of one request, including the connection.",
     .reload = settings,
     .target = into<&ActionSettings::webhook_timeout_s>},
    {.section = "actions",
     .key = "webhook_patience_s",
     .unit = "s",
     .min = 0,
     .max = 604800,
     .meaning = "How long to retry, after 1 s, 2 s, 4 s and so on up to 60 s. Then the event is "
                "lost and counted.",
     .reload = settings,
     .target = into<&ActionSettings::webhook_patience_s>},
};

using enum OptionType;
using enum Reach;

const Option kEventReport[] = {
    {.section = "event_report",
     .key = "directory",
     .type = text,
     .required = true,
     .meaning = "Directory, relative to this file; created if missing. Reports are written here.",
     .reload = restart,
     .is_path = true,
     .target = into<&EventReportSettings::directory>},
    {.section = "event_report",
     .key = "trigger_mps2",
     .unit = "m/s^2",
     .min = 1e-4,
     .max = 50,
     .meaning = "Strong motion begins when the base is this far from its mean.",
     .reload = restart,
     .target = into<&EventReportSettings::options, &estimator::ShakingOptions::trigger_mps2>},
    {.section = "event_report",
     .key = "quiet_s",
     .unit = "s",
     .min = 2,
     .max = 45,
     .meaning = "Strong motion ends after this time below the trigger.",
     .reload = restart,
     .target = into<&EventReportSettings::options, &estimator::ShakingOptions::quiet_s>},
    {.section = "event_report",
     .key = "yellow_drift_ratio",
     .min = 0,
     .max = 1,
     .meaning = "Peak drift over story height that makes the report yellow.",
     .reload = restart,
     .target = into<&EventReportSettings::yellow_drift_ratio>},
    {.section = "event_report",
     .key = "red_drift_ratio",
     .min = 0,
     .max = 1,
     .meaning = "Peak drift over story height that makes the report red.",
     .reload = restart,
     .target = into<&EventReportSettings::red_drift_ratio>},
    {.section = "event_report",
     .key = "yellow_loss_ratio",
     .min = 0,
     .max = 1,
     .meaning =
         "Lasting stiffness loss, beyond three standard errors, that makes the report yellow.",
     .reload = restart,
     .target = into<&EventReportSettings::yellow_loss_ratio>},
    {.section = "event_report",
     .key = "red_loss_ratio",
     .min = 0,
     .max = 1,
     .meaning = "Lasting stiffness loss that makes the report red.",
     .reload = restart,
     .target = into<&EventReportSettings::red_loss_ratio>},
    {.section = "event_report",
     .key = "most_reports",
     .type = integer,
     .min = 1,
     .max = 100000,
     .meaning = "Number of reports to keep; the oldest are removed.",
     .reload = restart,
     .target = into<&EventReportSettings::most_reports>},
};

constexpr std::string_view kByHand = "one for all stories or one for each; type may give it";

Option median(std::string_view key, std::string_view meaning) {
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

Option dispersion(std::string_view key, std::string_view meaning) {
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
     .meaning = "HAZUS building type: W wood, S steel (1 moment frame, 2 braced, 4 concrete walls, "
                "5 infill), C concrete (1 moment frame, 2 walls, 3 infill), PC precast, RM and URM "
                "reinforced and unreinforced masonry. L, M, H: low-, mid-, high-rise limits.",
     .reload = restart,
     .by_hand = "a text that is looked up in a table"},
    {.section = "fragility",
     .key = "design_level",
     .type = choice,
     .no_default = true,
     .choices = "high|moderate|low|pre",
     .meaning = "Seismic code of the design; required with type. pre: before codes. S5, C3 and URM "
                "have only low and pre.",
     .reload = restart,
     .target = into<&FragilitySettings::design_level>},
    {.section = "fragility",
     .key = "drift_limits",
     .type = choice,
     .choices = "story|height",
     .meaning = "story: types without L, M, H use low-rise limits, which apply to a single story. "
                "height: limits follow the number of stories and judge damage earlier.",
     .reload = restart,
     .target = into<&FragilitySettings::drift_limits>},
    median("slight_drift_ratio",
           "Median story drift ratio at which this damage begins. Default: by type."),
    median("moderate_drift_ratio",
           "Median story drift ratio at which this damage begins. Default: by type."),
    median("extensive_drift_ratio",
           "Median story drift ratio at which this damage begins. Default: by type."),
    median("complete_drift_ratio",
           "Median story drift ratio at which this damage begins. Default: by type."),
    dispersion(
        "slight_dispersion",
        "Standard deviation of that drift's logarithm, without the uncertainty of the shaking."),
    dispersion(
        "moderate_dispersion",
        "Standard deviation of that drift's logarithm, without the uncertainty of the shaking."),
    dispersion(
        "extensive_dispersion",
        "Standard deviation of that drift's logarithm, without the uncertainty of the shaking."),
    dispersion(
        "complete_dispersion",
        "Standard deviation of that drift's logarithm, without the uncertainty of the shaking."),
    {.section = "fragility",
     .key = "restricted_probability",
     .min = 0.01,
     .max = 0.99,
     .meaning =
         "Probability of at least moderate damage in a story for the placard restricted use.",
     .reload = restart,
     .target = into<&FragilitySettings::rules, &estimator::PlacardRules::restricted>},
    {.section = "fragility",
     .key = "unsafe_probability",
     .min = 0.01,
     .max = 0.99,
     .meaning = "Probability of at least extensive damage in a story for the placard unsafe.",
     .reload = restart,
     .target = into<&FragilitySettings::rules, &estimator::PlacardRules::unsafe>},
};

}  // namespace

std::span<const Option> action_options() {
  return kActions;
}

std::span<const Option> event_report_options() {
  return kEventReport;
}

std::span<const Option> fragility_options() {
  return kFragility;
}

}  // namespace framewatch::daemon
