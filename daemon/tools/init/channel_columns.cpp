// SPDX-License-Identifier: MIT
#include "daemon/tools/init/channel_columns.h"

#include <glob.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>
#include <fmt/format.h>

#include "daemon/base/file_digest.h"
#include "drivers/dbc/dbc.h"
#include "drivers/files/input_file.h"
#include "drivers/files/number_text.h"
#include "drivers/formats/record_file.h"
#include "drivers/records/record_builder.h"
#include "drivers/records/unit_text.h"

namespace framewatch::daemon {
namespace {

/// Largest relative rounding of a rate: rates are round numbers, but times in a file are rounded.
constexpr double kRounding = 1e-3;

double round_rate_hz(double rate_hz) {
  const double whole = std::round(rate_hz);
  return whole > 0 && std::abs(rate_hz / whole - 1) < kRounding ? whole : rate_hz;
}

std::string lines_of(const std::vector<drivers::Problem>& problems) {
  std::string out;
  for (const drivers::Problem& p : problems)
    out += fmt::format("{}{}: {}", out.empty() ? "" : "\n", p.where, p.message);
  return out;
}

void set_option(const std::string& name, const std::string& value, RecordAnswer& out) {
  RecordFileArguments& a = out.arguments;
  const auto split = [&] {
    std::vector<std::string_view> fields;
    drivers::split_commas(value, fields);
    return std::vector<std::string>(fields.begin(), fields.end());
  };
  for (const auto& [known, text] :
       {std::pair("unit", &a.unit), std::pair("time", &a.time),
        std::pair("time-unit", &a.time_unit), std::pair("zone", &a.zone),
        std::pair("station-xml", &a.station_xml), std::pair("decimal", &a.decimal),
        std::pair("format", &a.format)})
    if (name == known) {
      *text = value;
      return;
    }
  if (name == "step") {
    a.step_s = drivers::parse_number(value).value_or(-1);
    if (!(a.step_s > 0)) out.problem = "--step: seconds between samples, such as 0.01";
  } else if (name == "columns") {
    a.columns = split();
  } else if (name == "names") {
    a.names = split();
  } else {
    out.problem = fmt::format("there is no option --{} of a record", name);
  }
}

/// Splits names on separate lines and expands patterns to the matching files.
std::vector<std::string> files_of(const std::string& text) {
  std::vector<std::string> out;
  std::size_t at = 0;
  while (at <= text.size()) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string name = text.substr(at, end - at);
    at = end + 1;
    glob_t found{};
    const bool pattern = name.find_first_of("*?") != std::string::npos && drivers::is_absent(name);
    if (pattern && ::glob(name.c_str(), 0, nullptr, &found) == 0)
      out.insert(out.end(), found.gl_pathv, found.gl_pathv + found.gl_pathc);
    else
      out.push_back(name);
    ::globfree(&found);
  }
  return out;
}

}  // namespace

ChannelColumns columns_of_records(const std::vector<std::string>& paths,
                                  const RecordFileArguments& arguments) {
  ChannelColumns out;
  std::vector<drivers::Problem> problems;
  const drivers::RecordOptions options = record_options(arguments, problems);
  std::vector<drivers::Record> records;
  for (const std::string& path : paths)
    if (auto read = problems.empty() ? drivers::read_record(path, options, problems) : std::nullopt)
      records.push_back(std::move(*read));
  std::optional<drivers::Record> record;
  if (problems.empty() && paths.size() == 1) record = std::move(records.front());
  if (problems.empty() && paths.size() > 1)
    record = merge_records(std::move(records), paths, drivers::MergeSpan::common, problems);
  out.problem = lines_of(problems);
  if (!record) return out;
  for (std::size_t c = 0; c < record->names.size(); ++c)
    out.columns.push_back({record->names[c], "", 1,
                           record->headers.empty() ? drivers::AxisHeader{} : record->headers[c]});
  out.rate_hz = round_rate_hz(record->rate_hz);
  out.notes = record->notes;
  return out;
}

ChannelColumns columns_of_dbc(const std::string& path, const std::string& interface) {
  ChannelColumns out;
  std::string error;
  const std::optional<std::string> text = read_text_file(path, error);
  if (!text) {
    out.problem = path + ": " + error;
    return out;
  }
  std::vector<drivers::Problem> problems;
  const auto dbc = drivers::parse_dbc(path, *text, problems);
  out.problem = lines_of(problems);
  if (!dbc) return out;
  for (const drivers::DbcMessage& message : dbc->messages) {
    const std::vector<drivers::DbcRule> broken = broken_rules(message);
    bool noted = broken.empty();
    for (const drivers::DbcSignal& signal : message.signals)
      if (const auto scale = drivers::mps2_per(signal.unit); scale && !signal.is_multiplexor) {
        if (!std::exchange(noted, true))
          out.notes.push_back(fmt::format("{}:{}: {} is left out: {}", path, broken[0].line,
                                          message.name, broken[0].message));
        if (!broken.empty()) continue;
        const std::string name = message.name + "." + signal.name;
        out.columns.push_back(
            {name,
             fmt::format("{{ can = \"{}\", dbc_signal = \"{}\" }}", interface, name),
             *scale,
             {}});
      }
  }
  if (out.columns.empty())
    out.problem = path + ": no signal has a unit of acceleration (g, mg, gal, m/s^2)";
  return out;
}

RecordAnswer parse_record_answer(const std::string& text) {
  RecordAnswer out;
  std::size_t at = text.find(" --");
  out.paths = files_of(std::string(drivers::trimmed(std::string_view(text).substr(0, at))));
  while (at != std::string::npos && out.problem.empty()) {
    const std::size_t end = text.find(" --", at + 1);
    const std::string option(drivers::trimmed(
        std::string_view(text).substr(at + 3, end == std::string::npos ? end : end - at - 3)));
    const std::size_t blank = option.find_first_of(" =");
    set_option(option.substr(0, blank),
               blank == std::string::npos
                   ? ""
                   : std::string(drivers::trimmed(std::string_view(option).substr(blank + 1))),
               out);
    at = end;
  }
  return out;
}

std::string shell_word(const std::string& text) {
  const bool plain = !text.empty() && text.find_first_not_of(
                                          "abcdefghijklmnopqrstuvwxyz"
                                          "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                          "0123456789_-./,:+@%=") == std::string::npos;
  if (plain) return text;
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string options_text(const RecordFileArguments& a) {
  std::string out;
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) out += fmt::format(" --{} {}", option, shell_word(value));
  };
  add("unit", a.unit);
  add("station-xml", a.station_xml);
  if (a.step_s != 0) add("step", drivers::format_number(a.step_s));
  add("time", a.time);
  add("time-unit", a.time_unit);
  add("zone", a.zone);
  add("decimal", a.decimal);
  add("columns", fmt::format("{}", fmt::join(a.columns, ",")));
  add("names", fmt::format("{}", fmt::join(a.names, ",")));
  if (a.format != "detect") add("format", a.format);
  return out;
}

}  // namespace framewatch::daemon
