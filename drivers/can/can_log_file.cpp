// SPDX-License-Identifier: MIT
#include "drivers/can/can_log_file.h"

#include <algorithm>
#include <string_view>

#include <fmt/core.h>

#include "drivers/can/vector_log.h"
#include "drivers/files/line_reader.h"
#include "drivers/files/number_text.h"
#include "drivers/files/packed_file.h"

namespace framewatch::drivers {
namespace {

constexpr std::int64_t kNamedWithin = 10;  ///< lines

/// Names a format that the Python package python-can converts, and the command that does it.
std::string with_python_can(std::string_view what, std::string_view ending) {
  return fmt::format(
      "is {}, which is not read: python3 -m can.logconvert IN.{} OUT.log (Debian's python3-can) "
      "makes a candump log of it",
      what, ending);
}

/// Returns true for a line such as " (1700000000.000300)  can0  181   [8]  64 00 00 00", with or
/// without the stamp.
bool is_of_screen(std::string_view line) {
  std::vector<std::string_view> fields;
  split_blanks(line, fields);
  const auto length = std::find_if(fields.begin(), fields.end(), [](std::string_view field) {
    return field.size() >= 3 && field.size() <= 4 && field.front() == '[' && field.back() == ']';
  });
  if (length == fields.end() || length - fields.begin() < 2) return false;
  const std::string_view id = *(length - 1);
  return (id.size() == 3 || id.size() == 8) &&
         id.find_first_not_of("0123456789ABCDEFabcdef") == std::string_view::npos &&
         parse_integer(length->substr(1, length->size() - 2)).has_value();
}

/// Returns the number of decimals of the stamp if only they keep a line from being of candump; else
/// 0.
std::size_t other_decimals(std::string_view line) {
  const std::size_t dot = line.find('.'), close = line.find(')');
  if (dot == std::string_view::npos || close == std::string_view::npos || close < dot + 2) return 0;
  CanFrame frame;
  std::string_view interface;
  std::string rule;
  const std::string usual = fmt::format("{}.000000{}", line.substr(0, dot), line.substr(close));
  const std::size_t decimals = close - dot - 1;
  return decimals != 6 && decimals != 9 && parse_candump_line(usual, frame, interface, rule)
             ? decimals
             : 0;
}

}  // namespace

CanLogFormat can_log_format(const std::string& path) {
  return looks_like_candump(path) ? CanLogFormat::candump
         : looks_like_asc(path)   ? CanLogFormat::asc
         : looks_like_blf(path)   ? CanLogFormat::blf
                                  : CanLogFormat::none;
}

bool read_can_log(const std::string& path, std::optional<int> zone_min, const TakeCanFrame& take,
                  std::vector<std::string>& notes, std::vector<Problem>& problems) {
  switch (can_log_format(path)) {
    case CanLogFormat::asc:
      return read_asc(path, zone_min, take, notes, problems);
    case CanLogFormat::blf:
      return read_blf(path, zone_min, take, notes, problems);
    default:
      return read_candump(path, take, problems);
  }
}

std::string unread_can_log(const std::string& path) {
  GzipInput input;
  std::string head(8, '\0');
  if (input.open(path) && input.read(head.data(), std::ssize(head)) == std::ssize(head) &&
      (head == "MDF     " || head == "UnFinMF "))
    return with_python_can("ASAM MDF", "mf4");
  std::vector<Problem> ignored;
  FileProblems problems(path, ignored);
  LineReader lines(problems);
  std::string_view line;
  while (lines.number() < kNamedWithin && lines.next(line)) {
    const auto has = [&](std::string_view part) {
      return line.find(part) != std::string_view::npos;
    };
    if (line.starts_with(';') && (has("$FILEVERSION") || has("PCAN") || has(".trc")))
      return with_python_can("a PCAN trace (TRC)", "trc");
    if (line.starts_with("***BUSMASTER"))
      return "is a log of BUSMASTER, which is not read: its format converters make Vector ASC of "
             "it";
    if (is_of_screen(line))
      return "is what candump prints on a screen, which is not read: candump -l writes a log, and "
             "candump -L prints one";
    if (const std::size_t decimals = other_decimals(line); decimals > 0)
      return fmt::format(
          "has stamps of {} decimals: candump -l writes 6, with -N 9, and fewer are "
          "too coarse to time samples",
          decimals);
  }
  return {};
}

}  // namespace framewatch::drivers
