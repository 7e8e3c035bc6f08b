// SPDX-License-Identifier: MIT
#include "daemon/base/local_time.h"

#include <glib.h>

#include <fmt/core.h>

namespace framewatch::daemon {
namespace {

constexpr std::int64_t kSecondOfZone_us = 1'000'000;
constexpr std::size_t kClockText = 5, kSpanText = 11;  // characters of "08:00", "22:00-07:00"

using LocalTime = std::unique_ptr<GDateTime, decltype(&g_date_time_unref)>;

/// Returns null for times that GLib does not know, after the year 9999.
LocalTime local_time(void* zone, std::int64_t time_us) {
  const LocalTime utc(g_date_time_new_from_unix_utc(time_us / kSecondOfZone_us),
                      &g_date_time_unref);
  GDateTime* const local =
      utc ? g_date_time_to_timezone(utc.get(), static_cast<GTimeZone*>(zone)) : nullptr;
  return {local, &g_date_time_unref};
}

}  // namespace

std::optional<int> read_clock_time(const std::string& text) {
  if (text.size() != kClockText || text[2] != ':') return std::nullopt;
  for (const std::size_t i : {0, 1, 3, 4})
    if (text[i] < '0' || text[i] > '9') return std::nullopt;
  const int hour = 10 * (text[0] - '0') + text[1] - '0';
  const int minute = 10 * (text[3] - '0') + text[4] - '0';
  if (hour > 23 || minute > 59) return std::nullopt;
  return 60 * hour + minute;
}

std::optional<DailySpan> read_daily_span(const std::string& text) {
  if (text.size() != kSpanText || text[kClockText] != '-') return std::nullopt;
  const auto from = read_clock_time(text.substr(0, kClockText));
  const auto to = read_clock_time(text.substr(kClockText + 1));
  if (!from || !to || *from == *to) return std::nullopt;
  return DailySpan{*from, *to};
}

std::optional<TimeZone> TimeZone::find(const std::string& name) {
  if (name.empty()) return std::nullopt;
  GTimeZone* const zone = g_time_zone_new_identifier(name.c_str());
  if (zone == nullptr) return std::nullopt;
  TimeZone out;
  out.zone_ =
      std::shared_ptr<void>(zone, [](void* z) { g_time_zone_unref(static_cast<GTimeZone*>(z)); });
  return out;
}

int TimeZone::minute_of_day(std::int64_t time_us) const {
  const LocalTime t = local_time(zone_.get(), time_us);
  return t ? 60 * g_date_time_get_hour(t.get()) + g_date_time_get_minute(t.get()) : 0;
}

std::string TimeZone::day(std::int64_t time_us) const {
  const LocalTime t = local_time(zone_.get(), time_us);
  if (!t) return {};
  int year = 0, month = 0, day = 0;
  g_date_time_get_ymd(t.get(), &year, &month, &day);
  return fmt::format("{:04}-{:02}-{:02}", year, month, day);
}

}  // namespace framewatch::daemon
