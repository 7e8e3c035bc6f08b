#include "daemon/keys/event_report_options.h"

#include "daemon/keys/option_table.h"

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

}  // namespace

std::span<const Option> event_report_options() {
  return kOptions;
}

}  // namespace framewatch::daemon
