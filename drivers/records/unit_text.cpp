// SPDX-License-Identifier: MIT
#include "drivers/records/unit_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cmath>

#include "drivers/files/file_problems.h"
#include "drivers/files/number_text.h"

namespace framewatch::drivers {
namespace {

struct NamedUnit {
  std::string_view name;
  double in_si;
};

constexpr std::array kAccelUnits = {
    NamedUnit{"g", 9.80665},   NamedUnit{"mg", 9.80665e-3},   NamedUnit{"gal", 0.01},
    NamedUnit{"mps2", 1},      NamedUnit{"m/s2", 1},          NamedUnit{"m/s/s", 1},
    NamedUnit{"m/sec2", 1},    NamedUnit{"ms-2", 1},          NamedUnit{"cm/s2", 0.01},
    NamedUnit{"cm/s/s", 0.01}, NamedUnit{"cm/sec2", 0.01},    NamedUnit{"cms-2", 0.01},
    NamedUnit{"mm/s2", 0.001}, NamedUnit{"mm/s/s", 0.001},    NamedUnit{"mms-2", 0.001},
    NamedUnit{"um/s2", 1e-6},  NamedUnit{"um/s/s", 1e-6},     NamedUnit{"ums-2", 1e-6},
    NamedUnit{"nm/s2", 1e-9},  NamedUnit{"nm/s/s", 1e-9},     NamedUnit{"nms-2", 1e-9},
    NamedUnit{"m/sec/sec", 1}, NamedUnit{"cm/sec/sec", 0.01},
};
constexpr std::array kForceUnits = {NamedUnit{"n", 1}, NamedUnit{"kn", 1e3}};
constexpr std::array kTimeUnits = {
    NamedUnit{"s", 1},       NamedUnit{"sec", 1},   NamedUnit{"second", 1}, NamedUnit{"ms", 1e-3},
    NamedUnit{"msec", 1e-3}, NamedUnit{"us", 1e-6}, NamedUnit{"ns", 1e-9},  NamedUnit{"seconds", 1},
};

/// Returns a unit in lower case, without blanks, parentheses, and signs for powers and products:
/// "m / s^2", "m/s\u00b2" and "m/(s**2)" become "m/s2", "m s^-2" becomes "ms-2". The micro sign
/// becomes "u".
std::string plain_unit(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const unsigned char c = static_cast<unsigned char>(text[i]);
    if (c == 0xC2 || c == 0xCE) continue;  // first byte of these signs in UTF-8
    if (c == 0xB2)
      plain += '2';
    else if (c == 0xB5 || c == 0xBC)
      plain += 'u';
    else if (std::string_view(" ^*.()\xB7").find(text[i]) == std::string_view::npos)
      plain += static_cast<char>(std::tolower(c));
  }
  return plain;
}

template <std::size_t Count>
std::optional<double> unit_of(const std::array<NamedUnit, Count>& units, std::string_view text) {
  const std::string plain = plain_unit(text);
  for (const NamedUnit& unit : units)
    if (unit.name == plain) return unit.in_si;
  return std::nullopt;
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Returns true if the text has this shape, in which 0 stands for any digit.
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

std::optional<double> mps2_per(std::string_view unit) {
  return unit_of(kAccelUnits, unit);
}

std::optional<double> newtons_per(std::string_view unit) {
  return unit_of(kForceUnits, unit);
}

std::optional<double> declared_unit(std::string_view text) {
  if (const auto number = parse_number(text))
    return std::isfinite(*number) && *number > 0 ? number : std::nullopt;
  return mps2_per(text);
}

std::optional<double> seconds_per(std::string_view unit) {
  return unit_of(kTimeUnits, unit);
}

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
  // Wherever dates have dots, the day comes first.
  if (has_shape(plain, "00.00.0000T00:00:00"))
    plain =
        plain.substr(6, 4) + '-' + plain.substr(3, 2) + '-' + plain.substr(0, 2) + plain.substr(10);
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
           ": a date like this does not say which number is the month: write it as "
           "2026-11-21T17:00:00.01Z";
  if (has_shape(text.substr(0, 5), "0000-")) return shown + ": no such time";
  if (!text.empty() && is_digit(text[0]) && text.find(':') != std::string_view::npos)
    return shown +
           ": a time of day without its date cannot be read: write seconds, or "
           "2026-11-21T17:00:00.01Z";
  return shown + ": not a number";
}

}  // namespace framewatch::drivers
