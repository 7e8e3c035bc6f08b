// SPDX-License-Identifier: MIT
#include "drivers/formats/table.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>

#include <fmt/core.h>
#include <fmt/format.h>

#include "drivers/files/number_text.h"
#include "drivers/records/record_builder.h"
#include "drivers/records/record_options.h"
#include "drivers/records/unit_text.h"

namespace framewatch::drivers {
namespace {

constexpr std::array<std::string_view, 4> kNoValue = {"NA", "N/A", "#N/A", "null"};

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

/// The first title in tables of framewatch itself: all other columns are in m/s^2.
constexpr std::string_view kOwnTime = "time_s";

/// Units of the columns TIMESTAMP and RECORD of TOA5 files.
constexpr std::string_view kToa5TimeStamp = "TS", kToa5RecordNumber = "RN";

constexpr std::array<std::string_view, 22> kTimes = {
    "t",         "time",     "timestamp",    "datetime",     "date",       "utc",
    "seconds",   "sec",      "elapsedtime",  "relativetime", "sampletime", "epoch",
    "epochtime", "unixtime", "absolutetime", "date/time",    "zeit",       "zeitstempel",
    "tempo",     "tiempo",   "時刻",         "時間"};

/// Returns a text in lower case, without blanks, '_' and '-'.
std::string squeeze(std::string_view text) {
  std::string out;
  for (const char c : text)
    if (c != ' ' && c != '_' && c != '-')
      out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

bool is_time_name(std::string_view name) {
  return std::find(kTimes.begin(), kTimes.end(), squeeze(name)) != kTimes.end();
}

bool is_chosen(const std::vector<std::string>& wanted, const ColumnTitle& title,
               const std::string& text) {
  return std::any_of(wanted.begin(), wanted.end(),
                     [&](const std::string& name) { return name == title.name || name == text; });
}

/// Returns the titles, with the units of a separate line for those without a unit.
std::vector<ColumnTitle> titles_with(const std::vector<std::string>& texts,
                                     const std::vector<std::string>& units) {
  std::vector<ColumnTitle> titles;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    ColumnTitle& title = titles.emplace_back(column_title(texts[i]));
    if (!title.unit && i < units.size() && !units[i].empty())
      title.unit = column_title(units[i]).unit.value_or(units[i]);
  }
  return titles;
}

void find_time(const std::vector<std::string>& texts, const std::vector<ColumnTitle>& titles,
               const RecordOptions& options, std::int64_t line, TableColumns& out,
               FileProblems& problems) {
  std::vector<std::size_t> times;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const bool asked = texts[i] == options.time_column || titles[i].name == options.time_column;
    if (options.time_column.empty() ? is_time_title(texts[i]) : asked) times.push_back(i);
  }
  if (options.time_column.empty() && !texts.empty() && texts[0] == kOwnTime)
    std::erase_if(times, [&](std::size_t i) { return squeeze(texts[i]) == "t"; });
  if (times.size() > 1) {
    std::string names;
    for (const std::size_t i : times) names += (names.empty() ? "" : ", ") + show_text(texts[i]);
    problems.add(line,
                 fmt::format("several columns are times: {}; choose the time of the samples with "
                             "--time, and the channels with --columns",
                             names));
  } else if (times.empty() && !options.time_column.empty()) {
    problems.add(line,
                 fmt::format("--time {}: there is no such column", show_text(options.time_column)));
  } else if (times.empty() && !options.step_s) {
    problems.add(
        line,
        "no column is called Time, t, time_s or the like: name it with --time, or give the seconds "
        "between samples with --step");
  } else if (!times.empty() && options.step_s) {
    problems.add(line, fmt::format("the file has its own time, {}: --step does not apply",
                                   show_text(texts[times[0]])));
  } else if (!times.empty()) {
    out.time = times[0];
  }
}

void find_time_unit(const ColumnTitle& title, const RecordOptions& options, std::int64_t line,
                    TableColumns& out, FileProblems& problems) {
  const std::string name = squeeze(title.name);
  std::optional<double> said;
  if (title.unit && title.unit != kToa5TimeStamp) {
    said = seconds_per(*title.unit);
    if (!said)
      problems.add(line, fmt::format("{}: times are in s, ms, us or ns, not in {}",
                                     show_text(title.name), show_text(*title.unit)));
  } else if (name == "seconds" || name == "sec") {
    said = 1;
  }
  if (said && options.time_unit_s)
    problems.add(line, fmt::format("{} has its own unit: --time-unit does not apply",
                                   show_text(title.name)));
  out.time_unit_said = said || options.time_unit_s;
  out.time_unit_s = said.value_or(options.time_unit_s.value_or(1));
}

void add_channel(std::size_t column, const ColumnTitle& title, bool own,
                 const RecordOptions& options, std::int64_t line, bool& unit_used,
                 TableColumns& out, FileProblems& problems) {
  double unit_mps2 = 1;
  const bool is_force = title.unit && newtons_per(*title.unit);
  if (title.unit) {
    const auto said = is_force ? newtons_per(*title.unit) : mps2_per(*title.unit);
    if (!said)
      problems.add(line,
                   fmt::format("{}: {} is not a unit of acceleration (g, mg, gal, m/s^2, cm/s^2, "
                               "mm/s^2) or force (N, kN); select the channels with --columns",
                               show_text(title.name), show_text(*title.unit)));
    unit_mps2 = said.value_or(1);
  } else if (!own) {
    if (!options.unit_mps2)
      problems.add(line,
                   fmt::format("{}: the header does not say the unit; write {} [g], or declare "
                               "it with --unit g, mg, gal or mps2",
                               show_text(title.name), title.name));
    unit_mps2 = options.unit_mps2.value_or(1);
    unit_used = true;
  }
  out.channels.push_back({column, title.name, unit_mps2, is_force});
}

}  // namespace

char delimiter_of(std::string_view line) {
  bool quoted = false, tab = false, comma = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    if (c == ';') return ';';
    tab = tab || c == '\t';
    comma = comma || c == ',';
  }
  return tab ? '\t' : comma ? ',' : ' ';
}

std::optional<std::vector<std::string>> split_cells(std::string_view line, char delimiter) {
  const auto ends = [&](char c) { return delimiter == ' ' ? is_blank(c) : c == delimiter; };
  std::vector<std::string> cells;
  std::size_t at = 0;
  if (delimiter == ' ') line = trimmed(line);
  while (true) {
    while (at < line.size() && is_blank(line[at]) && line[at] != delimiter) ++at;
    std::string& cell = cells.emplace_back();
    if (at < line.size() && line[at] == '"') {
      for (++at;; ++at) {
        if (at >= line.size()) return std::nullopt;
        if (line[at] != '"')
          cell += line[at];
        else if (at + 1 < line.size() && line[at + 1] == '"')
          cell += line[at++];
        else
          break;
      }
      ++at;
      cell = trimmed(cell);
      while (at < line.size() && is_blank(line[at]) && !ends(line[at])) ++at;
      if (at < line.size() && !ends(line[at])) return std::nullopt;
    } else {
      const std::size_t begin = at;
      while (at < line.size() && !ends(line[at])) ++at;
      cell = trimmed(line.substr(begin, at - begin));
    }
    if (at >= line.size()) return cells;
    ++at;
    while (delimiter == ' ' && at < line.size() && is_blank(line[at])) ++at;
  }
}

bool is_comment(std::string_view line, char delimiter) {
  line = trimmed(line);
  if (line.empty() || line[0] == '#' || line[0] == '%' || line.substr(0, 2) == "//") return true;
  if (line[0] != ';' || delimiter != '\0') return line[0] == ';' && delimiter != ';';
  return line.find(';', 1) == std::string_view::npos && line.find(',') != std::string_view::npos;
}

bool is_toa5(std::string_view first_line) {
  return first_line.starts_with("\"TOA5\",") || first_line.starts_with("TOA5,");
}

std::string_view without_header_mark(std::string_view line) {
  constexpr std::string_view kMark = ";headers,";
  const bool marked = squeeze(line.substr(0, kMark.size())) == kMark;
  return marked ? trimmed(line.substr(kMark.size())) : line;
}

std::optional<double> parse_cell(std::string_view text, char decimal) {
  if (std::find(kNoValue.begin(), kNoValue.end(), text) != kNoValue.end())
    return std::numeric_limits<double>::quiet_NaN();
  if (decimal == '.' || text.find(',') == std::string_view::npos) {
    if (decimal == ',' && text.find('.') != std::string_view::npos) return std::nullopt;
    return parse_sample(text);
  }
  if (text.find('.') != std::string_view::npos) return std::nullopt;
  std::string plain(text);
  plain[plain.find(',')] = '.';
  return parse_sample(plain);
}

bool begins_data(std::string_view text) {
  const auto number = parse_cell(text, ',');
  return (number && !std::isnan(*number)) || parse_number(text) || parse_time_stamp(text);
}

void DecimalScan::add(std::int64_t line, std::string_view cell) {
  const std::size_t comma = cell.find(',');
  if (comma == std::string_view::npos) {
    const bool point = point_.line == 0 && cell.find('.') != std::string_view::npos;
    if (point && parse_number(cell)) point_ = {line, std::string(cell)};
    return;
  }
  std::string_view before = cell.substr(0, comma);
  if (!before.empty() && (before[0] == '-' || before[0] == '+')) before.remove_prefix(1);
  const std::string_view after = cell.substr(comma + 1);
  const bool grouped = before.size() >= 1 && before.size() <= 3 && before[0] != '0' &&
                       after.size() >= 3 &&
                       (after.size() == 3 || after[3] == ',' || after[3] == '.');
  Seen& seen = grouped ? thousands_ : comma_;
  if (seen.line == 0 && (grouped || parse_cell(cell, ','))) seen = {line, std::string(cell)};
}

std::optional<char> DecimalScan::decimal(FileProblems& problems) const {
  const Seen& commas = comma_.line > 0 ? comma_ : thousands_;
  if (commas.line == 0) return '.';
  if (point_.line > 0)
    return problems.add(
        std::max(point_.line, commas.line),
        fmt::format("{} in line {} has a decimal point, {} in line {} a comma: use one of "
                    "them throughout",
                    show_text(point_.text), point_.line, show_text(commas.text), commas.line));
  if (comma_.line > 0) return ',';
  problems.add(thousands_.line,
               fmt::format("{} may have a decimal comma or a comma between thousands: declare "
                           "--decimal comma, or remove such commas and declare --decimal point",
                           show_text(thousands_.text)));
  return std::nullopt;
}

ColumnTitle column_title(const std::string& text) {
  for (const char* pair : {"[]", "()"}) {
    const std::size_t open = text.rfind(pair[0]);
    if (open == std::string::npos || text.back() != pair[1]) continue;
    const std::string inside(
        trimmed(std::string_view(text).substr(open + 1, text.size() - open - 2)));
    if (pair[0] == '(' && !mps2_per(inside) && !seconds_per(inside) && !newtons_per(inside))
      continue;
    return {std::string(trimmed(std::string_view(text).substr(0, open))), inside};
  }
  const std::size_t behind = text.find_last_of("_/ ");
  if (behind == std::string::npos || behind == 0) return {text, {}};
  const std::string name = text.substr(0, text.find_last_not_of("_/, ", behind) + 1);
  const std::string unit = text.substr(behind + 1);
  if (is_time_name(name) && seconds_per(unit)) return {name, unit};
  return {text, {}};
}

bool is_time_title(const std::string& text) {
  return is_time_name(column_title(text).name);
}

std::optional<TableColumns> table_columns(const std::vector<std::string>& texts,
                                          const std::vector<std::string>& units,
                                          const RecordOptions& options, std::int64_t line,
                                          FileProblems& problems) {
  const std::vector<ColumnTitle> titles = titles_with(texts, units);
  TableColumns out;
  out.count = texts.size();
  find_time(texts, titles, options, line, out, problems);
  if (out.time) find_time_unit(titles[*out.time], options, line, out, problems);
  const bool own = out.time == 0U && texts[0] == kOwnTime;
  bool unit_used = false;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (out.time == i) continue;
    if (i == 0 && texts[i].empty() && texts.size() > 1) {
      out.notes.push_back("the first column has no title: an index, left out");
      continue;
    }
    if (titles[i].unit == kToa5RecordNumber) {
      out.notes.push_back(fmt::format("{}: record numbers, left out", show_text(texts[i])));
      continue;
    }
    if (!options.columns.empty() && !is_chosen(options.columns, titles[i], texts[i])) {
      out.notes.push_back(fmt::format("{}: not one of --columns, left out", show_text(texts[i])));
      continue;
    }
    add_channel(i, titles[i], own, options, line, unit_used, out, problems);
    names.push_back(titles[i].name);
  }
  for (const std::string& wanted : options.columns)
    if (std::none_of(out.channels.begin(), out.channels.end(), [&](const auto& channel) {
          return channel.name == wanted || texts[channel.column] == wanted;
        }))
      problems.add(line, fmt::format("--columns {}: there is no such column", show_text(wanted)));
  if (out.channels.empty() && !problems.any()) problems.add(line, "the header names no channel");
  if (options.unit_mps2 && !unit_used && !out.channels.empty())
    problems.add(line, "the file states its units: --unit does not apply");
  check_names(names, line, problems);
  if (problems.any()) return std::nullopt;
  return out;
}

}  // namespace framewatch::drivers
