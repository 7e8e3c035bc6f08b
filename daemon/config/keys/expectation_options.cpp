// SPDX-License-Identifier: MIT
#include "daemon/config/keys/option_table.h"

namespace framewatch::daemon {
namespace {

using enum OptionType;

const Option kExpect[] = {
    {.key = "reason",
     .type = text,
     .required = true,
     .meaning = "Why these numbers are right; not empty."},
};

const Option kExpectParameter[] = {
    {.key = "name", .type = text, .meaning = "Parameter name; this or `group`."},
    {.key = "group",
     .choices = "all|frame_stiffness|panel_stiffness|frame_damping|panel_damping",
     .meaning = "All parameters of a group."},
    {.key = "median", .meaning = "Median of the observable windows."},
    {.key = "q1", .meaning = "Lower quartile."},
    {.key = "q3", .meaning = "Upper quartile."},
    {.key = "value", .meaning = "Value of every observable window."},
    {.key = "tolerance", .range = {0}, .meaning = "Tolerance of these, in the parameter's unit."},
    {.key = "tolerance_ratio",
     .range = {0},
     .meaning = "Tolerance relative to the expected value."},
    {.key = "tolerance_std_errors",
     .range = {0},
     .meaning = "Tolerance in published standard errors: a window's own for `value`, otherwise "
                "the median one."},
    {.key = "observable_ratio", .range = {0, 1}, .meaning = "Share of windows with a value."},
    {.key = "observable_tolerance",
     .default_value = "0",
     .range = {0, 1},
     .meaning = "Tolerance of that share."},
    {.key = "observable_min_ratio",
     .range = {0, 1},
     .meaning = "Smallest share of windows with a value."},
    {.key = "observable_max_ratio",
     .range = {0, 1},
     .meaning = "Largest share of windows with a value."},
};

/// Keys of parameters and events.
const Option kExpectTime[] = {
    {.key = "from_s",
     .unit = "s",
     .range = {0},
     .meaning = "Start after the first sample; windows count by their end."},
    {.key = "to_s", .unit = "s", .range = {0}, .meaning = "End of the range."},
};

constexpr std::string_view kExactly = "Exactly the number in the summary.";

const Option kExpectCounts[] = {
    {.key = "windows", .type = integer, .range = {0}, .meaning = kExactly},
    {.key = "gaps", .type = integer, .range = {0}, .meaning = kExactly},
    {.key = "lost", .type = integer, .range = {0}, .meaning = kExactly},
    {.key = "late", .type = integer, .range = {0}, .meaning = kExactly},
    {.key = "repaired", .type = integer, .range = {0}, .meaning = kExactly},
    {.key = "rejected", .type = integer, .range = {0}, .meaning = kExactly},
    {.key = "stuck", .type = integer, .range = {0}, .meaning = kExactly},
    {.key = "clipped", .type = integer, .range = {0}, .meaning = kExactly},
    {.key = "malformed", .type = integer, .range = {0}, .meaning = kExactly},
    {.key = "foreign", .type = integer, .range = {0}, .meaning = kExactly},
    {.key = "windows_min", .type = integer, .range = {0}, .meaning = "Least number of windows."},
};

const Option kExpectEvent[] = {
    {.key = "kind", .type = text, .meaning = "Kind of event. Default: any."},
    {.key = "place", .type = text, .meaning = "Parameter or channel. Default: any."},
    {.key = "count",
     .type = integer,
     .default_value = "1",
     .range = {0},
     .meaning = "Number of events."},
};

}  // namespace

std::vector<OptionSection> expectation_options() {
  return {{"expect", kExpect},
          {"expect.parameter", kExpectParameter},
          {"expect.parameter", kExpectTime},
          {"expect.event", kExpectTime},
          {"expect.counts", kExpectCounts},
          {"expect.event", kExpectEvent}};
}

}  // namespace framewatch::daemon
