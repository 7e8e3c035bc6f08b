// SPDX-License-Identifier: MIT
#include "daemon/config/keys/option_table.h"

namespace framewatch::daemon {
namespace {

using enum OptionType;

constexpr std::string_view kGroups =
    "all|frame_stiffness|panel_stiffness|frame_damping|panel_damping";

Option at_least_0(std::string_view section, std::string_view key, OptionType type,
                  std::string_view unit, std::string_view meaning) {
  return {.section = section, .key = key, .type = type, .unit = unit, .min = 0, .meaning = meaning};
}

Option ratio(std::string_view key, std::string_view meaning) {
  return {.section = "expect.parameter", .key = key, .min = 0, .max = 1, .meaning = meaning};
}

Option any_number(std::string_view key, std::string_view meaning) {
  return {.section = "expect.parameter", .key = key, .meaning = meaning};
}

std::vector<Option> make() {
  std::vector<Option> all{
      {.section = "expect",
       .key = "reason",
       .type = text,
       .required = true,
       .meaning = "Why these numbers are right; not empty."},
      {.section = "expect.parameter",
       .key = "name",
       .type = text,
       .meaning = "Parameter name; this or `group`."},
      {.section = "expect.parameter",
       .key = "group",
       .type = choice,
       .choices = kGroups,
       .meaning = "All parameters of a group."},
      any_number("median", "Median of the observable windows."),
      any_number("q1", "Lower quartile."),
      any_number("q3", "Upper quartile."),
      any_number("value", "Value of every observable window."),
      at_least_0("expect.parameter", "tolerance", number, "",
                 "Tolerance of these, in the parameter's unit."),
      at_least_0("expect.parameter", "tolerance_ratio", number, "",
                 "Tolerance relative to the expected value."),
      at_least_0("expect.parameter", "tolerance_std_errors", number, "",
                 "Tolerance in published standard errors: a window's own for `value`, otherwise "
                 "the median one."),
      ratio("observable_ratio", "Share of windows with a value."),
      {.section = "expect.parameter",
       .key = "observable_tolerance",
       .default_value = "0",
       .min = 0,
       .max = 1,
       .meaning = "Tolerance of that share."},
      ratio("observable_min_ratio", "Smallest share of windows with a value."),
      ratio("observable_max_ratio", "Largest share of windows with a value."),
  };
  for (const std::string_view section : {"expect.parameter", "expect.event"}) {
    all.push_back(at_least_0(section, "from_s", number, "s",
                             "Start after the first sample; windows count by their end."));
    all.push_back(at_least_0(section, "to_s", number, "s", "End of the range."));
  }
  for (const std::string_view name : {"windows", "gaps", "lost", "late", "repaired", "rejected",
                                      "stuck", "clipped", "malformed", "foreign"})
    all.push_back(
        at_least_0("expect.counts", name, integer, "", "Exactly the number in the summary."));
  all.push_back(
      at_least_0("expect.counts", "windows_min", integer, "", "Least number of windows."));
  all.push_back({.section = "expect.event",
                 .key = "kind",
                 .type = text,
                 .meaning = "Kind of event. Default: any."});
  all.push_back({.section = "expect.event",
                 .key = "place",
                 .type = text,
                 .meaning = "Parameter or channel. Default: any."});
  Option count = at_least_0("expect.event", "count", integer, "", "Number of events.");
  count.default_value = "1";
  all.push_back(count);
  return all;
}

}  // namespace

std::span<const Option> expectation_options() {
  static const std::vector<Option> kAll = make();
  return kAll;
}

}  // namespace framewatch::daemon
