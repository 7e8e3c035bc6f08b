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
       .meaning = "Why these numbers are right, for whoever has to change them; not empty."},
      {.section = "expect.parameter",
       .key = "name",
       .type = text,
       .meaning = "The parameter; this or `group`."},
      {.section = "expect.parameter",
       .key = "group",
       .type = choice,
       .choices = kGroups,
       .meaning = "Every parameter of a group."},
      any_number("median", "Of the observable windows, in the parameter's unit."),
      any_number("q1", "Lower quartile, likewise."),
      any_number("q3", "Upper quartile, likewise."),
      any_number("value", "Of every observable window, likewise."),
      at_least_0("expect.parameter", "tolerance", number, "",
                 "How far these may be off, in the parameter's unit."),
      at_least_0("expect.parameter", "tolerance_ratio", number, "", "The same as a share of them."),
      at_least_0(
          "expect.parameter", "tolerance_std_errors", number, "",
          "The same in standard errors as published: a window's own for `value`, the median one "
          "for the others."),
      ratio("observable_ratio", "Share of the windows that have a value."),
      {.section = "expect.parameter",
       .key = "observable_tolerance",
       .default_value = "0",
       .min = 0,
       .max = 1,
       .meaning = "How far that may be off."},
      ratio("observable_min_ratio", "Least share of the windows that have a value."),
      ratio("observable_max_ratio", "Largest share, 0: it must never have one."),
  };
  for (const std::string_view section : {"expect.parameter", "expect.event"}) {
    all.push_back(at_least_0(section, "from_s", number, "s",
                             "Only from here on, after the first sample; of windows their end."));
    all.push_back(at_least_0(section, "to_s", number, "s", "Only up to here."));
  }
  for (const std::string_view name : {"windows", "gaps", "lost", "late", "repaired", "rejected",
                                      "stuck", "clipped", "malformed", "foreign"})
    all.push_back(at_least_0("expect.counts", name, integer, "", "As in the summary, exactly."));
  all.push_back(
      at_least_0("expect.counts", "windows_min", integer, "", "At least so many windows."));
  all.push_back({.section = "expect.event",
                 .key = "kind",
                 .type = text,
                 .meaning = "Of the event_t messages that are raised; without it any."});
  all.push_back({.section = "expect.event",
                 .key = "place",
                 .type = text,
                 .meaning = "Parameter or channel; without it any."});
  Option count = at_least_0("expect.event", "count", integer, "", "How many of them.");
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
