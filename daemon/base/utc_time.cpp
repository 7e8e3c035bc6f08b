// SPDX-License-Identifier: MIT
#include "daemon/base/utc_time.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <ctime>
#include <system_error>

#include <fmt/core.h>

#include "daemon/base/clocks.h"

namespace framewatch::daemon {
namespace {

namespace ch = std::chrono;

constexpr std::int64_t kYear2000_us = 946'684'800'000'000;
constexpr std::size_t kStampLength = 16;  // 20261121T231500Z

struct Civil {
  int year;
  unsigned month, day;
  int hour, minute, second, microsecond;
};

/// Clamps to the years 0 to 9999, because damaged messages can have any time.
Civil civil(std::int64_t time_us) {
  using Time = ch::sys_time<ch::microseconds>;
  constexpr Time kEarliest = ch::sys_days(ch::year(0) / 1 / 1);
  constexpr Time kLatest = ch::sys_days(ch::year(10'000) / 1 / 1) - ch::microseconds(1);
  const Time time = std::clamp(Time(ch::microseconds(time_us)), kEarliest, kLatest);
  const auto day = ch::floor<ch::days>(time);
  const ch::year_month_day date(day);
  const ch::hh_mm_ss clock(time - day);
  return {static_cast<int>(date.year()),
          static_cast<unsigned>(date.month()),
          static_cast<unsigned>(date.day()),
          static_cast<int>(clock.hours().count()),
          static_cast<int>(clock.minutes().count()),
          static_cast<int>(clock.seconds().count()),
          static_cast<int>(clock.subseconds().count())};
}

std::optional<std::int64_t> microseconds(int year, int month, int day, int hour, int minute,
                                         double second) {
  const ch::year_month_day date{ch::year(year), ch::month(static_cast<unsigned>(month)),
                                ch::day(static_cast<unsigned>(day))};
  if (!date.ok() || hour < 0 || hour > 24 || minute < 0 || minute > 59 || !(second >= 0) ||
      second >= 61)
    return std::nullopt;
  const std::int64_t days = ch::sys_days(date).time_since_epoch().count();
  return ((days * 24 + hour) * 60 + minute) * 60 * kSecond_us + std::llround(second * 1e6);
}

/// Parses a number that takes up the whole text. Returns false for anything else.
template <typename Number>
bool whole(std::string_view text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return !text.empty() && error == std::errc() && end == text.data() + text.size();
}

}  // namespace

std::string utc_stamp(std::int64_t time_us) {
  const Civil c = civil(time_us);
  return fmt::format("{:04}{:02}{:02}T{:02}{:02}{:02}Z", c.year, c.month, c.day, c.hour, c.minute,
                     c.second);
}

std::optional<std::int64_t> read_utc_stamp(std::string_view s) {
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, second = 0;
  if (s.size() < kStampLength || s[8] != 'T' || s[15] != 'Z' || !whole(s.substr(0, 4), year) ||
      !whole(s.substr(4, 2), month) || !whole(s.substr(6, 2), day) ||
      !whole(s.substr(9, 2), hour) || !whole(s.substr(11, 2), minute) ||
      !whole(s.substr(13, 2), second))
    return std::nullopt;
  return microseconds(year, month, day, hour, minute, second);
}

std::string utc_text(std::int64_t time_us) {
  const Civil c = civil(time_us);
  std::string out = fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}", c.year, c.month, c.day,
                                c.hour, c.minute, c.second);
  if (c.microsecond != 0) out += fmt::format(".{:03}", c.microsecond / 1000);
  return out + "Z";
}

std::optional<std::int64_t> read_utc(const std::string& text) {
  if (double seconds = 0; whole(std::string_view(text), seconds)) {
    if (!(std::abs(seconds) < 9e9)) return std::nullopt;
    return std::llround(seconds * 1e6);
  }
  std::string_view s = text;
  if (s.ends_with('Z')) s.remove_suffix(1);
  int year = 0, month = 0, day = 0, hour = 0, minute = 0;
  double second = 0;
  if (s.size() < 10 || s[4] != '-' || s[7] != '-' || !whole(s.substr(0, 4), year) ||
      !whole(s.substr(5, 2), month) || !whole(s.substr(8, 2), day))
    return std::nullopt;
  if (s.size() == 10) return microseconds(year, month, day, 0, 0, 0);
  if (s.size() < 16 || (s[10] != 'T' && s[10] != ' ') || s[13] != ':' ||
      !whole(s.substr(11, 2), hour) || !whole(s.substr(14, 2), minute))
    return std::nullopt;
  if (s.size() > 16 && (s[16] != ':' || !whole(s.substr(17), second))) return std::nullopt;
  return microseconds(year, month, day, hour, minute, second);
}

std::string sensor_time_text(std::int64_t time_us) {
  if (time_us < kYear2000_us) return fmt::format("{:.3f} s", 1e-6 * static_cast<double>(time_us));
  const Civil c = civil(time_us);
  return fmt::format("{}-{:02}-{:02} {:02}:{:02}:{:02} UTC", c.year, c.month, c.day, c.hour,
                     c.minute, c.second);
}

std::string sensor_clock_text(std::int64_t time_us) {
  if (time_us < kYear2000_us) return sensor_time_text(time_us);
  const Civil c = civil(time_us);
  return fmt::format("{:02}:{:02}:{:02}", c.hour, c.minute, c.second);
}

std::string utc_and_local_text(std::int64_t time_us) {
  const auto seconds = static_cast<std::time_t>(time_us / 1'000'000);
  std::tm local{};
  std::array<char, 64> text{};
  const std::string utc = sensor_time_text(time_us);
  if (::localtime_r(&seconds, &local) == nullptr || local.tm_gmtoff == 0) return utc;
  const Civil c = civil(time_us);
  const bool same_day = static_cast<unsigned>(local.tm_mday) == c.day;
  const std::size_t length = std::strftime(
      text.data(), text.size(), same_day ? "%H:%M:%S %Z" : "%Y-%m-%d %H:%M:%S %Z", &local);
  return fmt::format("{} ({})", utc, std::string_view(text.data(), length));
}

}  // namespace framewatch::daemon
