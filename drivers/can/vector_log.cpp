// SPDX-License-Identifier: MIT
#include "drivers/can/vector_log.h"

#include <linux/can/error.h>

#include <array>
#include <chrono>

#include <fmt/core.h>

namespace framewatch::drivers {

std::int64_t start_of_log(const std::optional<LogDate>& date, std::optional<int> zone_min,
                          std::vector<std::string>& notes) {
  namespace chrono = std::chrono;
  const LogDate d = date.value_or(LogDate{});
  const chrono::year_month_day day{chrono::year(d.year),
                                   chrono::month(static_cast<unsigned>(d.month)),
                                   chrono::day(static_cast<unsigned>(d.day))};
  if (!day.ok() || d.year < 1970 || d.year > 2200 || d.hour > 23 || d.minute > 59 ||
      d.second > 60 || d.millisecond > 999) {
    notes.push_back("the start has no date that is understood: times begin at 0");
    return 0;
  }
  if (!zone_min)
    notes.push_back("the date of the start has no time zone: it counts as UTC without --zone");
  const std::int64_t minutes =
      1440 * std::int64_t{chrono::sys_days(day).time_since_epoch().count()} + 60 * d.hour +
      d.minute - zone_min.value_or(0);
  return 1'000 * (60'000 * minutes + 1'000 * d.second + d.millisecond);
}

std::string interface_of_channel(unsigned channel) {
  return fmt::format("can{}", static_cast<std::int64_t>(channel) - 1);
}

int bytes_of_code(unsigned code, bool fd) {
  constexpr std::array kLong = {12, 16, 20, 24, 32, 48, 64};
  if (code <= 8) return static_cast<int>(code);
  return fd && code < 16 ? kLong[code - 9] : 8;
}

CanFrame plain_error_frame(std::int64_t stamp_us) {
  CanFrame frame;
  frame.stamp_us = stamp_us;
  frame.error = true;
  frame.id = CAN_ERR_BUSERROR;
  frame.length = CAN_ERR_DLC;
  return frame;
}

}  // namespace framewatch::drivers
