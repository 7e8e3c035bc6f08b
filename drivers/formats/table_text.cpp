#include "drivers/formats/table_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include "drivers/files/number_text.h"
#include "drivers/records/unit_text.h"

namespace framewatch::drivers {
namespace {

constexpr std::array<std::string_view, 4> kNoValue = {"NA", "N/A", "#N/A", "null"};

bool is_blank(char c) {
  return c == ' ' || c == '\t';
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

bool is_comment(std::string_view line) {
  line = trimmed(line);
  return line.empty() || line[0] == '#' || line[0] == '%' || line.substr(0, 2) == "//";
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
  if (point_.line > 0) {
    problems.add(
        std::max(point_.line, commas.line),
        fmt::format("{} in line {} has a decimal point, {} in line {} a comma: one of them "
                    "is to be written otherwise",
                    show_text(point_.text), point_.line, show_text(commas.text), commas.line));
    return std::nullopt;
  }
  if (comma_.line > 0) return ',';
  problems.add(thousands_.line,
               fmt::format("{} can be one and some thousandths or some thousands: declare it with "
                           "--decimal comma or, after taking such commas out, --decimal point",
                           show_text(thousands_.text)));
  return std::nullopt;
}

}  // namespace framewatch::drivers
