#include "drivers/records/time_text.h"

#include <algorithm>
#include <chrono>

#include "drivers/files/file_problems.h"
#include "drivers/files/number_text.h"

namespace framewatch::drivers {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Whether the text has this shape, in which 0 stands for any digit.
bool has_shape(std::string_view text, std::string_view shape) {
  return std::equal(text.begin(), text.end(), shape.begin(), shape.end(),
                    [](char c, char s) { return s == '0' ? is_digit(c) : c == s; });
}

int digits(std::string_view text, std::size_t at, std::size_t count) {
  int value = 0;
  for (const char c : text.substr(at, count)) value = 10 * value + (c - '0');
  return value;
}

}  // namespace

std::optional<int> parse_zone(std::string_view text) {
  if (text == "Z" || text == "z" || text == "UTC") return 0;
  const bool short_form = has_shape(text.substr(std::min<std::size_t>(1, text.size())), "0000");
  const bool long_form = has_shape(text.substr(std::min<std::size_t>(1, text.size())), "00:00");
  if ((!short_form && !long_form) || (text[0] != '+' && text[0] != '-')) return std::nullopt;
  const int hours = digits(text, 1, 2), minutes = digits(text, long_form ? 4 : 3, 2);
  if (hours > 15 || minutes > 59) return std::nullopt;
  return (text[0] == '-' ? -1 : 1) * (60 * hours + minutes);
}

std::optional<TimeStamp> parse_time_stamp(std::string_view text) {
  constexpr std::string_view kShape = "0000-00-00T00:00:00";
  if (text.size() < kShape.size()) return std::nullopt;
  std::string plain(text.substr(0, kShape.size()));
  if (plain[10] == ' ' || plain[10] == 't') plain[10] = 'T';
  if (!has_shape(plain, kShape)) return std::nullopt;
  text.remove_prefix(kShape.size());
  std::size_t fraction = 0;
  if (!text.empty() && (text[0] == '.' || text[0] == ','))
    for (fraction = 1; fraction < text.size() && is_digit(text[fraction]);) ++fraction;
  if (fraction == 1) return std::nullopt;
  std::string seconds = plain.substr(17) + std::string(text.substr(0, fraction));
  std::replace(seconds.begin(), seconds.end(), ',', '.');
  text = trimmed(text.substr(fraction));
  const std::chrono::year_month_day day{
      std::chrono::year(digits(plain, 0, 4)),
      std::chrono::month(static_cast<unsigned>(digits(plain, 5, 2))),
      std::chrono::day(static_cast<unsigned>(digits(plain, 8, 2)))};
  const int hour = digits(plain, 11, 2), minute = digits(plain, 14, 2);
  const auto second = parse_number(seconds);
  const auto offset_min = parse_zone(text);
  if (!day.ok() || hour > 23 || minute > 59 || !second || *second >= 61) return std::nullopt;
  if (!text.empty() && !offset_min) return std::nullopt;
  const auto days = std::chrono::sys_days(day).time_since_epoch().count();
  return TimeStamp{86400.0 * static_cast<double>(days) + 3600.0 * hour + 60.0 * minute + *second,
                   offset_min};
}

std::string why_no_time(std::string_view text) {
  const std::string shown = show_text(text);
  const bool slashes =
      text.find('/') != std::string_view::npos || std::count(text.begin(), text.end(), '.') >= 2;
  if (!text.empty() && is_digit(text[0]) && slashes)
    return shown +
           ": day and month of such a date can be exchanged: write it as "
           "2026-11-21T17:00:00.01Z";
  if (has_shape(text.substr(0, 5), "0000-")) return shown + ": no such time";
  if (!text.empty() && is_digit(text[0]) && text.find(':') != std::string_view::npos)
    return shown +
           ": a clock time without its date is not read: write seconds, or "
           "2026-11-21T17:00:00.01Z";
  return shown + ": no number";
}

}  // namespace framewatch::drivers
